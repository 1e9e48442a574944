#pragma once
/// Checks enclose() and round_to_float() with numbers that the oracle knows exactly.

#include "exact/numbers/root.hpp"
#include "oracle/exact_numbers.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace microtrace::oracle {

/// Real is Rational, or a CGAL number that can be compared with Rational.
template <class Real>
[[nodiscard]] bool is_enclosed(const Real& t, const exact::Enclosure& e) {
  const bool above = Rational(e.lo) <= t;
  const bool below = std::isinf(e.hi) || t <= Rational(e.hi);
  const bool tight =
      std::isinf(e.hi) || e.hi - e.lo <= std::max(0x1p-47 * std::abs(e.hi), 0x1p-990);
  return above && below && tight;
}

/// Returns true if f is the float32 number nearest to t, with ties to even. Compares t with the
/// midpoints between f and its neighbors.
template <class Real>
[[nodiscard]] bool is_nearest(float f, const Real& t) {
  const auto value = [](float x) {
    return Rational(std::isinf(x) ? std::copysign(0x1p128, x) : double{x});
  };
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const bool even = std::bit_cast<std::uint32_t>(f) % 2 == 0;
  if (f < infinity) {
    const Rational middle = (value(f) + value(std::nextafter(f, infinity))) / 2;
    if (middle < t || (middle == t && !even)) return false;
  }
  if (f > -infinity) {
    const Rational middle = (value(f) + value(std::nextafter(f, -infinity))) / 2;
    if (t < middle || (middle == t && !even)) return false;
  }
  return true;
}

}  // namespace microtrace::oracle
