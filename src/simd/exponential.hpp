#pragma once
/// Powers and logarithms for N lanes of float64. They use only + - * / and integer operations, so
/// their bits depend on nothing but IEEE 754. Errors are below two units in the last place, unless
/// stated otherwise. For logarithms with a magnitude below 1, the absolute error is below 2^-52.

#include "simd/vectors.hpp"

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

template <int N>
inline Double<N> floor_of(const Double<N>& a) {
#if defined(__AVX512F__)
  if constexpr (N == 8) return _mm512_maskz_roundscale_pd(0xff, a, _MM_FROUND_TO_NEG_INF);
#endif
#if defined(__AVX2__)
  if constexpr (N == 4) return _mm256_floor_pd(a);
#endif
  Double<N> result{};
  for (int i = 0; i < N; ++i) set_lane(result, i, __builtin_floor(lane(a, i)));
  return result;
}

/// Adding this number to an integer of magnitude below 2^51 leaves the integer's two's complement
/// in the lowest bits.
constexpr double kIntegerBits = 0x1.8p52;

/// Returns 2^x for x in [-1000, 1000].
template <int N>
inline Double<N> power_of_two(const Double<N>& x) {
  constexpr double kLn2 = 0x1.62e42fefa39efp-1;
  const Double<N> whole = floor_of<N>(x + 0.5);
  const Double<N> y = (x - whole) * kLn2;  // in [-0.347, 0.347]
  // Taylor polynomial of e^y, whose first omitted term is below 2^-57.
  Double<N> sum = Double<N>{} + 1;
  for (int k = 13; k > 0; --k) sum = 1 + y * sum / k;
  const auto exponent = reinterpreted<Long<N>>(Double<N>(whole + (kIntegerBits + 1023)));
  return sum * reinterpreted<Double<N>>(Long<N>(exponent << 52));
}

/// Returns the binary logarithm of x, which must be a positive, normal and finite number.
template <int N>
inline Double<N> binary_logarithm(const Double<N>& x) {
  constexpr double kSqrt2 = 0x1.6a09e667f3bcdp+0, kLn2 = 0x1.62e42fefa39efp-1;
  constexpr std::int64_t kFraction = (std::int64_t{1} << 52) - 1;
  const auto bits = reinterpreted<Long<N>>(x);
  auto m = reinterpreted<Double<N>>(Long<N>((bits & kFraction) | std::int64_t{1023} << 52));
  Double<N> exponent =
      reinterpreted<Double<N>>(Long<N>((bits >> 52) | std::int64_t{0x433} << 52)) - (0x1p52 + 1023);
  const auto is_high = m > kSqrt2;
  m = is_high ? m / 2 : m;
  exponent = is_high ? exponent + 1 : exponent;
  // ln m = 2 artanh s with |s| <= 0.1716. The first omitted term of the series is below 2^-60.
  const Double<N> s = (m - 1) / (m + 1), z = s * s;
  Double<N> sum{};
  for (int k = 21; k > 0; k -= 2) sum = 1.0 / k + z * sum;
  return exponent + 2 / kLn2 * (s * sum);
}

/// Returns e^x for x <= 690, and 0 for x < -690. The relative error is at most 2^-50 per unit of
/// |x|.
template <int N>
inline Double<N> exponential(const Double<N>& x) {
  constexpr double kLog2e = 0x1.71547652b82fep+0;
  const auto is_zero = x < -690;
  return is_zero ? Double<N>{} : power_of_two<N>(is_zero ? Double<N>{} : x * kLog2e);
}

/// Returns x^y for x in [0, 1] and y > 0, and 0 for results below 2^-1000. The relative error is at
/// most 2^-50 per unit of |y log2 x|.
template <int N>
inline Double<N> power(const Double<N>& x, const Double<N>& y) {
  const auto is_normal = x >= 0x1p-1000;
  const Double<N> exponent = y * binary_logarithm<N>(is_normal ? x : Double<N>{} + 1);
  const auto is_above_zero = is_normal & (exponent >= -1000);
  return is_above_zero ? power_of_two<N>(is_above_zero ? exponent : Double<N>{}) : Double<N>{};
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
