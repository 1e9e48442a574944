#pragma once
/// Fractions of exact numbers, which are never divided, and their bounds and roundings.

#include "exact/numbers/limbs.hpp"

#include <bit>
#include <cmath>
#include <compare>
#include <concepts>
#include <cstdint>

namespace microtrace::exact {

/// The number p / r, r > 0.
template <class Number>
struct Ratio {
  Number p, r;
};

/// p / r for r != 0.
template <class Number>
[[nodiscard]] Ratio<Number> ratio(const Number& p, const Number& r) {
  if (r.sign() < 0) return {-p, -r};
  return {p, r};
}

/// The order of two quotients.
template <class Number>
[[nodiscard]] std::strong_ordering compare(const Ratio<Number>& x, const Ratio<Number>& y) {
  return (x.p * y.r - y.p * x.r).sign() <=> 0;
}

/// Doubles lo <= x <= hi around a number x.
struct Enclosure {
  double lo, hi;
};

/// A positive number mantissa 2^exponent. The relative error is stated by the function that returns
/// it.
struct Scaled {
  double mantissa;
  int exponent;
};

/// Bounds of a number with this sign and magnitude, whose mantissa is in [1/8, 8] with an error of
/// at most 9 u, u = 2^-53. The bounds allow 16 u, which covers their own rounding and second-order
/// terms. Beyond 2^1000 or below 2^-1000 they extend to the range of double.
[[nodiscard]] Enclosure bounds(int sign, const Scaled& size);

/// A double close to a number of this sign and magnitude: the middle of its bounds, so that x and
/// -x give opposite results.
[[nodiscard]] double middle(int sign, const Leading& size);

/// The float32 nearest to a number within the bounds, ties to even, overflow to infinity (IEEE 754
/// roundTiesToEven). compare(x) is the order of the number and x.
template <std::invocable<double> Compare>
[[nodiscard]] float round_to_float(const Enclosure& e, const Compare& compare) {
  const auto below = static_cast<float>(e.lo);
  const auto above = static_cast<float>(e.hi);
  if (std::bit_cast<std::uint32_t>(below) == std::bit_cast<std::uint32_t>(above)) return below;
  // The enclosure contains the midpoint of two neighboring floats. IEEE 754 rounds as if 2^128
  // followed the largest float.
  const auto value = [](float f) { return std::isinf(f) ? std::copysign(0x1p128, f) : double{f}; };
  const std::strong_ordering order = compare((value(below) + value(above)) / 2);
  if (order != 0) return order < 0 ? below : above;
  return std::bit_cast<std::uint32_t>(below) % 2 == 0 ? below : above;
}

}  // namespace microtrace::exact
