#pragma once
/// Sine and cosine for N lanes of float64. They use only + - * / and integer operations, so their
/// bits depend on nothing but IEEE 754. Errors are below two units in the last place.

#include "simd/exponential.hpp"
#include "simd/masks.hpp"

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

// Taylor polynomials for [-pi/4, pi/4], whose first omitted terms are below 2^-63.
template <int N>
inline Double<N> sin_polynomial(const Double<N>& x) {
  const Double<N> z = x * x;
  Double<N> s = Double<N>{} + 1.0 / 355687428096000.0;  // 17!
  s = s * z - 1.0 / 1307674368000.0;                    // 15!
  s = s * z + 1.0 / 6227020800.0;                       // 13!
  s = s * z - 1.0 / 39916800.0;                         // 11!
  s = s * z + 1.0 / 362880.0;                           // 9!
  s = s * z - 1.0 / 5040.0;                             // 7!
  s = s * z + 1.0 / 120.0;                              // 5!
  s = s * z - 1.0 / 6.0;                                // 3!
  return x + x * (z * s);
}
template <int N>
inline Double<N> cos_polynomial(const Double<N>& x) {
  const Double<N> z = x * x;
  Double<N> c = Double<N>{} - 1.0 / 6402373705728000.0;  // 18!
  c = c * z + 1.0 / 20922789888000.0;                    // 16!
  c = c * z - 1.0 / 87178291200.0;                       // 14!
  c = c * z + 1.0 / 479001600.0;                         // 12!
  c = c * z - 1.0 / 3628800.0;                           // 10!
  c = c * z + 1.0 / 40320.0;                             // 8!
  c = c * z - 1.0 / 720.0;                               // 6!
  c = c * z + 1.0 / 24.0;                                // 4!
  return 1.0 - (0.5 * z - z * z * c);
}

/// An angle as a multiple of pi/2 plus a remainder.
template <int N>
struct ReducedAngle {
  Double<N> angle;   ///< the remainder in radians, in [-pi/4, pi/4]
  Long<N> quadrant;  ///< the multiple of pi/2; only its value modulo 4 counts

  [[nodiscard]] Double<N> sine() const {
    const Double<N> value =
        (quadrant & 1) != 0 ? cos_polynomial<N>(angle) : sin_polynomial<N>(angle);
    return (quadrant & 2) != 0 ? -value : value;
  }
  [[nodiscard]] Double<N> cosine() const { return ReducedAngle{angle, quadrant + 1}.sine(); }
};

/// Reduces |x| <= 2^20 radians by the method of W. Cody and W. Waite. pi/2 is split into three
/// parts, of which the first two have 33 bits, so their products with n are exact.
template <int N>
inline ReducedAngle<N> reduced_radians(const Double<N>& x) {
  constexpr double kTwoByPi = 0x1.45f306dc9c883p-1;
  constexpr double kPart1 = 0x1.921fb544p+0, kPart2 = 0x1.0b4611a6p-34,
                   kPart3 = 0x1.3198a2e037073p-69;
  const Double<N> n = floor_of<N>(x * kTwoByPi + 0.5);
  return {((x - n * kPart1) - n * kPart2) - n * kPart3,
          reinterpreted<Long<N>>(Double<N>(n + kIntegerBits))};
}

template <int N>
inline Double<N> cos_radians(const Double<N>& x) {
  return reduced_radians<N>(x).cosine();
}

/// Returns fmod(x, 2 pi) for x >= 0, where 2 pi is rounded to float64.
template <int N>
inline Double<N> within_revolution(const Double<N>& x) {
  // kHigh has 33 bits and kLow has 20, so all products and differences are exact while n has at
  // most 20 bits.
  constexpr double kWhole = 0x1.921fb54442d18p+2, kHigh = 0x1.921fb544p+2, kLow = kWhole - kHigh;
  const Double<N> n = floor_of<N>(x * (1 / kWhole));
  if (any(n > 0x1p20)) {
    Double<N> result{};
    for (int i = 0; i < N; ++i) set_lane(result, i, __builtin_fmod(lane(x, i), kWhole));
    return result;
  }
  Double<N> rest = (x - n * kHigh) - n * kLow;
  rest = rest < 0 ? rest + kWhole : rest;
  return rest >= kWhole ? rest - kWhole : rest;
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
