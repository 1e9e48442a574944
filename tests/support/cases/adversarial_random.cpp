#include "support/cases/adversarial_rays.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace microtrace::adversarial {

std::uint32_t Random::bits() {
  state_ ^= state_ >> 12;
  state_ ^= state_ << 25;
  state_ ^= state_ >> 27;
  return static_cast<std::uint32_t>((state_ * 0x2545F4914F6CDD1Du) >> 32);
}

int Random::between(int lo, int hi) {
  const auto count = static_cast<std::uint64_t>(hi - lo) + 1;
  return lo + static_cast<int>((bits() * count) >> 32);
}

double Random::unit() {
  return bits() * 0x1p-32;
}

float Random::power_of_two(int lo, int hi) {
  return std::ldexp(1.0f, between(lo, hi));
}

float Random::any_float(int lo, int hi) {
  const int exponent = between(lo, hi);
  const float mantissa = one_in(4) ? static_cast<float>(between(0, 16)) * 0x1p-3f
                                   : 1 + static_cast<float>(bits() >> 9) * 0x1p-23f;
  const float x = std::ldexp(mantissa, exponent);
  const float magnitude = std::isfinite(x) ? x : std::numeric_limits<float>::max();
  return one_in(2) ? magnitude : -magnitude;
}

Vec3 Random::any_vector(int lo, int hi) {
  const float x = any_float(lo, hi), y = any_float(lo, hi), z = any_float(lo, hi);
  return {x, y, z};
}

Vec3 Random::in_cube(float half_width) {
  const float x = symmetric(), y = symmetric(), z = symmetric();
  return Vec3(x, y, z) * half_width;
}

Vec3 Random::on_grid(int n, float spacing) {
  const int x = between(-n, n), y = between(-n, n), z = between(-n, n);
  return Vec3(x, y, z) * spacing;
}

Vec3 Random::jitter(const Vec3& v, int n) {
  const int x = between(-n, n), y = between(-n, n), z = between(-n, n);
  return {moved(v.x, x), moved(v.y, y), moved(v.z, z)};
}

Ray ray(const Line& line) {
  return {.o = line.o, .t_min = 0, .d = line.d, .t_max = std::numeric_limits<float>::infinity()};
}

float moved(float x, int n) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t magnitude = bits & 0x7fffffff;
  constexpr std::int32_t margin = 0x100;
  if (magnitude < margin || magnitude > 0x7f800000 - margin) return x;
  const std::int64_t target = std::int64_t{magnitude} + n;
  if (target < 0 || target >= 0x7f800000) return x;
  return std::bit_cast<float>(bits ^ magnitude ^ static_cast<std::int32_t>(target));
}

}  // namespace microtrace::adversarial
