#pragma once
/// Quotients of exact numbers that are never divided, and bounds and roundings of them.

#include "exact/numbers/limbs.hpp"

#include <bit>
#include <cmath>
#include <compare>
#include <concepts>
#include <cstdint>

namespace microtrace::exact {

/// p / r with r > 0.
template <class Number>
struct Ratio {
  Number p, r;
};

/// p / r for r not zero.
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

/// Doubles lo <= hi around a number.
struct Enclosure {
  double lo, hi;
};

/// A positive number mantissa 2^exponent, known to a relative error stated where it is made.
struct Scaled {
  double mantissa;
  int exponent;
};

/// Around a number of that sign and size, whose mantissa is in [1/8, 8] with an error of 9 u at
/// most, u = 2^-53: the bounds allow 16 u, with room for their own rounding and for second-order
/// terms. Beyond 2^1000 or below 2^-1000 they are as wide as the range of double.
[[nodiscard]] Enclosure bounds(int sign, const Scaled& size);

/// A double next to a number of that sign and size: the middle of its bounds, so that x and -x have
/// one size.
[[nodiscard]] double middle(int sign, const Leading& size);

/// The float32 nearest to a number within the bounds, ties to even, overflow to infinity: IEEE 754
/// roundTiesToEven. compare(x) is the number's order against x.
template <std::invocable<double> Compare>
[[nodiscard]] float round_to_float(const Enclosure& e, const Compare& compare) {
  const auto below = static_cast<float>(e.lo);
  const auto above = static_cast<float>(e.hi);
  if (std::bit_cast<std::uint32_t>(below) == std::bit_cast<std::uint32_t>(above)) return below;
  // The enclosure straddles the midpoint of two neighbouring floats. IEEE 754 rounds as if 2^128
  // followed the largest.
  const auto value = [](float f) { return std::isinf(f) ? std::copysign(0x1p128, f) : double{f}; };
  const std::strong_ordering order = compare((value(below) + value(above)) / 2);
  if (order != 0) return order < 0 ? below : above;
  return std::bit_cast<std::uint32_t>(below) % 2 == 0 ? below : above;
}

}  // namespace microtrace::exact
