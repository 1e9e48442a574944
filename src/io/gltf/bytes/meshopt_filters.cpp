#include "io/gltf/bytes/meshopt_filters.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

namespace microtrace::io::gltf {
namespace {

/// Converts x in [-1, 1] to a normalized integer. Rounds halves away from zero. Converts NaN to 0.
template <typename Integer>
Integer normalized(float x) {
  constexpr auto kGreatest = static_cast<float>(std::numeric_limits<Integer>::max());
  if (!(x >= -1)) return static_cast<Integer>(x < -1 ? -kGreatest : 0);
  if (x > 1) x = 1;
  return static_cast<Integer>(x * kGreatest + (x < 0 ? -0.5F : 0.5F));
}

template <typename Integer>
void decode_octahedral(std::string& bytes) {
  std::array<Integer, 4> v;
  for (std::size_t i = 0; i + sizeof v <= bytes.size(); i += sizeof v) {
    std::memcpy(v.data(), &bytes[i], sizeof v);
    const auto one = static_cast<float>(v[2]);
    float x = static_cast<float>(v[0]) / one, y = static_cast<float>(v[1]) / one;
    const float z = 1 - std::abs(x) - std::abs(y);
    const float t = z < 0 ? z : 0;  // moves the lower hemisphere's folded points back
    x -= std::copysign(t, x);
    y -= std::copysign(t, y);
    const float length = std::sqrt(x * x + y * y + z * z);
    v[0] = normalized<Integer>(x / length);
    v[1] = normalized<Integer>(y / length);
    v[2] = normalized<Integer>(z / length);
    std::memcpy(&bytes[i], v.data(), sizeof v);
  }
}

/// Returns the normalized integer that is nearest to value / one, clamped to [0, 1]. Returns 0 if
/// `one` is 0.
template <typename Integer>
Integer rescaled(int value, int one) {
  constexpr std::int64_t kGreatest = std::numeric_limits<Integer>::max();
  if (one == 0) return 0;
  return static_cast<Integer>((2 * std::clamp(value, 0, one) * kGreatest + one) / (2 * one));
}

template <typename Integer>
void decode_colors(std::string& bytes) {
  using Signed = std::make_signed_t<Integer>;
  std::array<Integer, 4> v;
  for (std::size_t i = 0; i + sizeof v <= bytes.size(); i += sizeof v) {
    std::memcpy(v.data(), &bytes[i], sizeof v);
    // The highest bit of alpha only marks the number of bits. Alpha has one bit less than the other
    // components; its last bit is repeated.
    const int one = (1 << std::bit_width(v[3])) - 1, alpha = v[3] & one >> 1;
    const int luma = v[0], orange = static_cast<Signed>(v[1]), green = static_cast<Signed>(v[2]);
    v[0] = rescaled<Integer>(luma + orange - green, one);
    v[1] = rescaled<Integer>(luma + green, one);
    v[2] = rescaled<Integer>(luma - orange - green, one);
    v[3] = rescaled<Integer>(alpha << 1 | (alpha & 1), one);
    std::memcpy(&bytes[i], v.data(), sizeof v);
  }
}

/// Returns 2^e for e in [-128, 127].
double power_of_two(int e) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + e) << 52U);
}

}  // namespace

void decode_octahedral(std::string& bytes, std::size_t stride) {
  return stride == 4 ? decode_octahedral<std::int8_t>(bytes)
                     : decode_octahedral<std::int16_t>(bytes);
}

void decode_quaternions(std::string& bytes) {
  constexpr float kRange = 0.70710678118654752F;  // maximum of each of the three smaller components
  std::array<std::int16_t, 4> v;
  for (std::size_t i = 0; i + sizeof v <= bytes.size(); i += sizeof v) {
    std::memcpy(v.data(), &bytes[i], sizeof v);
    const auto one = static_cast<float>(v[3] | 3);
    const auto greatest = static_cast<std::size_t>(v[3] & 3);
    const float x = static_cast<float>(v[0]) / one * kRange;
    const float y = static_cast<float>(v[1]) / one * kRange;
    const float z = static_cast<float>(v[2]) / one * kRange;
    const float square = 1 - x * x - y * y - z * z;
    v[(greatest + 1) % 4] = normalized<std::int16_t>(x);
    v[(greatest + 2) % 4] = normalized<std::int16_t>(y);
    v[(greatest + 3) % 4] = normalized<std::int16_t>(z);
    v[greatest] = normalized<std::int16_t>(std::sqrt(square > 0 ? square : 0));
    std::memcpy(&bytes[i], v.data(), sizeof v);
  }
}

void decode_exponential(std::string& bytes) {
  for (std::size_t i = 0; i + 4 <= bytes.size(); i += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, &bytes[i], 4);
    const int exponent = static_cast<std::int32_t>(word) >> 24U;
    const int mantissa = static_cast<std::int32_t>(word << 8U) >> 8U;
    const auto value = static_cast<float>(mantissa * power_of_two(exponent));
    std::memcpy(&bytes[i], &value, 4);
  }
}

void decode_colors(std::string& bytes, std::size_t stride) {
  return stride == 4 ? decode_colors<std::uint8_t>(bytes) : decode_colors<std::uint16_t>(bytes);
}

}  // namespace microtrace::io::gltf
