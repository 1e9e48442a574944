#include "io/gltf/animation/keyframes.hpp"

#include "scene/math/trigonometry.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <glm/geometric.hpp>

namespace microtrace::io::gltf {
namespace {

Quaternion quaternion_of(const std::vector<double>& numbers) {
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

/// Returns the value or tangent with this index among the sampler's outputs.
std::vector<double> output(const Keyframes& keys, std::size_t number) {
  const float* first = keys.values->data() + number * keys.width;
  return {first, first + keys.width};
}

std::vector<double> at_key(const Keyframes& keys, std::size_t key) {
  return output(keys, keys.interpolation == Interpolation::cubic_spline ? 3 * key + 1 : key);
}

std::vector<double> linear(const Keyframes& keys, std::size_t key, double t) {
  std::vector<double> result = at_key(keys, key);
  const std::vector<double> next = at_key(keys, key + 1);
  if (keys.are_rotations) {
    const Quaternion q =
        slerp(unit_quaternion(quaternion_of(result)), unit_quaternion(quaternion_of(next)), t);
    return {q.x, q.y, q.z, q.w};
  }
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = (1 - t) * result[i] + t * next[i];
  return result;
}

/// Interpolates by a cubic Hermite spline. Tangents are stored per second, so they are multiplied
/// by the seconds between the keys.
std::vector<double> cubic(const Keyframes& keys, std::size_t key, double t, double seconds) {
  std::vector<double> result = at_key(keys, key);
  const std::vector<double> next = at_key(keys, key + 1);
  const std::vector<double> out_tangent = output(keys, 3 * key + 2);
  const std::vector<double> in_tangent = output(keys, 3 * (key + 1));
  const double t2 = t * t, t3 = t2 * t;
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = (2 * t3 - 3 * t2 + 1) * result[i] + seconds * (t3 - 2 * t2 + t) * out_tangent[i] +
                (3 * t2 - 2 * t3) * next[i] + seconds * (t3 - t2) * in_tangent[i];
  }
  return result;
}

/// Frames are at multiples of 1 / fps, but the keys that were authored there have times in float32,
/// which may be a few units in the last place greater. The factor lets a step show its key in that
/// frame instead of in the next one.
constexpr double kReached = 1 + 0x1p-21;

std::vector<double> between_keys(const Keyframes& keys, double time) {
  const std::vector<float>& times = *keys.times;
  if (keys.interpolation == Interpolation::step) time *= kReached;
  if (!(time > times.front())) return at_key(keys, 0);
  if (time >= times.back()) return at_key(keys, times.size() - 1);
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  const auto key = static_cast<std::size_t>(after - times.begin()) - 1;
  const double start = times[key], seconds = times[key + 1] - start;
  const double t = (time - start) / seconds;
  switch (keys.interpolation) {
    case Interpolation::step:
      return at_key(keys, key);
    case Interpolation::linear:
      return linear(keys, key, t);
    case Interpolation::cubic_spline:
      return cubic(keys, key, t, seconds);
  }
  return {};
}

}  // namespace

bool is_ascending(const std::vector<float>& times) {
  return are_finite(times) && std::ranges::adjacent_find(
                                  times, [](float a, float b) { return !(a < b); }) == times.end();
}

bool are_finite(const std::vector<float>& numbers) {
  return std::ranges::all_of(numbers, [](float x) { return std::isfinite(x); });
}

void keep_ascending(Keyframes& keys) {
  const std::size_t size = keys.width * (keys.interpolation == Interpolation::cubic_spline ? 3 : 1);
  std::vector<float> times, values;
  for (std::size_t i = 0; i < keys.times->size(); ++i) {
    const float time = (*keys.times)[i];
    const std::span value(keys.values->data() + i * size, size);
    const bool is_finite =
        std::isfinite(time) && std::ranges::all_of(value, [](float x) { return std::isfinite(x); });
    if (!is_finite || (!times.empty() && time <= times.back())) continue;
    times.push_back(time);
    values.insert(values.end(), value.begin(), value.end());
  }
  keys.times = std::make_shared<const std::vector<float>>(std::move(times));
  keys.values = std::make_shared<const std::vector<float>>(std::move(values));
}

std::vector<double> value_at(const Keyframes& keys, double time) {
  std::vector<double> result = between_keys(keys, time);
  if (!keys.are_rotations) return result;
  const Quaternion q = unit_quaternion(quaternion_of(result));
  return {q.x, q.y, q.z, q.w};
}

Quaternion slerp(const Quaternion& a, const Quaternion& b, double t) {
  const Quaternion near_b = glm::dot(a, b) < 0 ? -b : b;
  // The angle between a and b, in [0, pi/2]. It is computed by an arctangent, because the arccosine
  // of a . b would be inaccurate for small angles.
  const double across = glm::length(a - near_b), along = glm::length(a + near_b);
  const double angle = 2 * atan_radians(across / along);
  if (!(angle > 0)) return a;
  const double sine = sin_radians(angle);
  return a * (sin_radians((1 - t) * angle) / sine) + near_b * (sin_radians(t * angle) / sine);
}

Quaternion unit_quaternion(const Quaternion& q) {
  const double largest = std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z), std::abs(q.w)});
  if (!(largest > 0)) return q;
  const Quaternion scaled = q / largest;  // keeps the squares below from overflowing
  return scaled / glm::length(scaled);
}

}  // namespace microtrace::io::gltf
