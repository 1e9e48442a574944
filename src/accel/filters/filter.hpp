#pragma once
/// Floating-point filters. A filter decides in float64 with a proven error bound whether a ray hits
/// a shape, or reports that it is unsure.
///
/// A filter object holds a shape relative to one ray origin o. Its constructor computes all terms
/// that depend only on o, for example once for all rays of a camera; each direction then takes only
/// a few multiplications. The constructors take float32 data. Some filters test N rays at a time;
/// one ray is the case N = 1.
///
/// Every bound below counts roundings as N. Higham does (Accuracy and Stability of Numerical
/// Algorithms, 2002, section 3.1). If each term of a sum of products has at most k roundings, the
/// error of the sum is at most gamma_k = k U / (1 - k U) times the sum of the terms' magnitudes,
/// where U is the unit roundoff. That sum of magnitudes is called the "permanent".
/// tests/property/bounds has inputs for which smaller counts would be wrong.

#include "accel/filters/roundings.hpp"
#include "accel/filters/seen_shapes.hpp"
#include "simd/vector3.hpp"

#include <microtrace/math.hpp>

#include <cmath>
#include <limits>

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// The filters' limit on the magnitude of all inputs; exact arithmetic handles larger ones. Within
/// the limit no intermediate result overflows. Underflow changes a form of degree six by less than
/// kUnderflow: at most a few hundred times 2^-1075 times 2^(6 * 64).
inline constexpr float kLargestCoordinate = 0x1p64F;

[[nodiscard]] constexpr double gamma(double roundings) {
  return roundings * kRounding;
}

enum class Certainty { miss, hit, unsure };

/// The result of a filter. If it is not a miss, lo is a lower bound of the exact t of the hit,
/// should there be one. If it is a hit, hi is an upper bound.
struct FilterResult {
  Certainty certainty = Certainty::miss;
  double lo = -std::numeric_limits<double>::infinity();
  double hi = std::numeric_limits<double>::infinity();
};

/// True or false for each of N rays. Not bool for one ray, because the operators & and | on bool
/// return int.
template <int N>
struct RayMaskOf {
  using type = Long<N>;
};
template <>
struct RayMaskOf<1> {
  using type = int;
};
template <int N>
using RayMask = typename RayMaskOf<N>::type;

/// The results for N rays. A ray that is neither in `miss` nor in `hit` is unsure; none is in both.
template <int N>
struct FilterResults {
  RayMask<N> miss, hit;
  Double<N> lo, hi;
};

/// Converts the result for one ray.
[[nodiscard]] inline FilterResult result_of(const FilterResults<1>& ray) {
  if (ray.miss != 0) return {.certainty = Certainty::miss};
  return {
      .certainty = ray.hit != 0 ? Certainty::hit : Certainty::unsure, .lo = ray.lo, .hi = ray.hi};
}

/// The closed intervals of t in which N rays can hit.
template <int N>
struct Ranges {
  Double<N> t_min, t_max;
};
using Range = Ranges<1>;

/// Rounded numbers and upper bounds of their errors, for N rays.
template <int N>
struct Approximates {
  Double<N> value, error;

  [[nodiscard]] RayMask<N> is_positive() const { return value > error; }
  [[nodiscard]] RayMask<N> is_negative() const { return value < -error; }
};
using Approximate = Approximates<1>;

[[nodiscard]] inline Bounded bounded(const Approximate& a) {
  return {.value = a.value, .error = a.error};
}
template <int N>
[[nodiscard]] inline Approximates<N> all_rays(const Bounded& a) {
  const Double<N> zero{};
  return {.value = a.value - zero, .error = a.error - zero};
}

/// Returns the sum of x_i y_i. `roundings` is the maximum number of roundings of a term, including
/// those of x_i and y_i, one of the product and two of the sum.
template <int N = 1>
[[nodiscard]] inline Approximates<N> dot_product(const Doubles3<N>& x, const Doubles3<N>& y,
                                                 int roundings) {
  const Double<N> a = x.x * y.x, b = x.y * y.y, c = x.z * y.z;
  return {.value = a + b + c,
          .error = gamma(roundings) * (magnitude(a) + magnitude(b) + magnitude(c)) + kUnderflow};
}

/// True if a number is within the filters' limit; false for NaN.
[[nodiscard]] inline bool is_filterable(float x) {
  return std::abs(x) <= kLargestCoordinate;
}
[[nodiscard]] inline bool is_filterable(const Vec3& v) {
  return is_filterable(v.x) && is_filterable(v.y) && is_filterable(v.z);
}

/// Compares the interval of t = numerator / denominator with the range. The quotient q of the
/// rounded numbers n and d differs from the exact quotient q* by |q - q*| <= (error_n + |q|
/// error_d) / (|d| - error_d). This bound itself is computed with eight roundings of second order,
/// for which the factor 1 + gamma(8) would suffice. Any |d| above its error would be valid;
/// requiring four times the error keeps lo and hi close.
template <int N = 1>
[[nodiscard]] inline FilterResults<N> quotient_result(const Approximates<N>& numerator,
                                                      const Approximates<N>& denominator,
                                                      const Ranges<N>& range) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Double<N> size = magnitude(denominator.value), none{};
  const RayMask<N> has_t = size > 4 * denominator.error;
  const Double<N> t = numerator.value / denominator.value;
  const Double<N> error = (numerator.error + magnitude(t) * denominator.error) /
                              (size - denominator.error) * (1 + gamma(16)) +
                          magnitude(t) * gamma(kQuotientRoundings) + kUnderflow;
  const Double<N> lo = t - error, hi = t + error;
  return {.miss = has_t & ((hi < range.t_min) | (lo > range.t_max)),
          .hit = has_t & (lo >= range.t_min) & (hi <= range.t_max),
          .lo = has_t ? lo : none - kInfinity,
          .hi = has_t ? hi : none + kInfinity};
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
