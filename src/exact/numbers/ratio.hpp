#pragma once
/// Quotients of exact numbers, kept as numerator and denominator, with float64 bounds and rounding
/// to float32.

#include "exact/numbers/limbs.hpp"

#include <bit>
#include <cmath>
#include <compare>
#include <concepts>
#include <cstdint>
#include <optional>

namespace microtrace::exact {

/// The number p / r, where r > 0.
template <class Number>
struct Ratio {
  Number p, r;
};

/// Returns p / r, where r must not be zero.
template <class Number>
[[nodiscard]] Ratio<Number> ratio(const Number& p, const Number& r) {
  if (r.sign() < 0) return {-p, -r};
  return {p, r};
}

/// Compares two quotients exactly.
template <class Number>
[[nodiscard]] std::strong_ordering compare(const Ratio<Number>& x, const Ratio<Number>& y) {
  return (x.p * y.r - y.p * x.r).sign() <=> 0;
}

/// Bounds of a number x: lo <= x <= hi.
struct Enclosure {
  double lo, hi;
};

/// Returns x rounded to the nearest float32, or nothing if the bounds are rounded differently. The
/// result is never -0.
[[nodiscard]] inline std::optional<float> rounded(const Enclosure& x) {
  const auto below = static_cast<float>(x.lo), above = static_cast<float>(x.hi);
  return below == above ? std::optional(below + 0.0F) : std::nullopt;
}

/// A positive number mantissa 2^exponent. The function that returns it documents the relative
/// error.
struct Scaled {
  double mantissa;
  int exponent;
};

/// Returns bounds of a number with this sign and magnitude. The mantissa must be in [1/8, 8] with a
/// relative error of at most 9 u, u = 2^-53. The bounds allow 16 u, which covers their own rounding
/// and second-order terms. For magnitudes beyond 2^1000 or below 2^-1000, they extend to infinity
/// or 0.
[[nodiscard]] Enclosure bounds(int sign, const Scaled& size);

/// Returns a double close to a number with this sign and magnitude. This is the middle of its
/// bounds, so x and -x give opposite results.
[[nodiscard]] double middle(int sign, const Leading& size);

/// Returns the float32 nearest to a number within the bounds, with ties to even and overflow to
/// infinity (IEEE 754 roundTiesToEven). compare(x) must return the order of the number and x.
template <std::invocable<double> Compare>
[[nodiscard]] float round_to_float(const Enclosure& e, const Compare& compare) {
  const auto below = static_cast<float>(e.lo);
  const auto above = static_cast<float>(e.hi);
  if (std::bit_cast<std::uint32_t>(below) == std::bit_cast<std::uint32_t>(above)) return below;
  // The bounds enclose the midpoint of two neighboring floats. IEEE 754 rounds as if 2^128 were the
  // number after the largest float.
  const auto value = [](float f) { return std::isinf(f) ? std::copysign(0x1p128, f) : double{f}; };
  const std::strong_ordering order = compare((value(below) + value(above)) / 2);
  if (order != 0) return order < 0 ? below : above;
  return std::bit_cast<std::uint32_t>(below) % 2 == 0 ? below : above;
}

}  // namespace microtrace::exact
