#pragma once
/// Floating-point filters. A filter decides in float64 with a proven error bound whether a ray hits
/// a shape, or reports that it is unsure.
///
/// A filter object holds a shape relative to one ray origin o. Its constructor computes all terms
/// that depend only on o, for example once for all rays of a camera; each direction then takes only
/// a few multiplications. The constructors take float32 data.
///
/// Every bound below counts roundings as N. Higham does (Accuracy and Stability of Numerical
/// Algorithms, 2002, section 3.1). If each term of a sum of products has at most k roundings, the
/// error of the sum is at most gamma_k = k U / (1 - k U) times the sum of the terms' magnitudes,
/// where U is the unit roundoff. That sum of magnitudes is called the "permanent".
/// tests/property/bounds has inputs for which smaller counts would be wrong.

#include "accel/filters/roundings.hpp"

#include <microtrace/math.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace microtrace {

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

/// The closed interval of t in which a ray can hit.
struct Range {
  double t_min, t_max;
};

/// A rounded number and an upper bound of its error.
struct Approximate {
  double value, error;

  [[nodiscard]] bool is_positive() const { return value > error; }
  [[nodiscard]] bool is_negative() const { return value < -error; }
};

/// Returns the sum of x_i y_i. `roundings` is the maximum number of roundings of a term, including
/// those of x_i and y_i, one of the product and two of the sum.
[[nodiscard]] inline Approximate dot_product(const DVec3& x, const DVec3& y, int roundings) {
  const double a = x.x * y.x, b = x.y * y.y, c = x.z * y.z;
  return {.value = a + b + c,
          .error = gamma(roundings) * (std::abs(a) + std::abs(b) + std::abs(c)) + kUnderflow};
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
[[nodiscard]] inline FilterResult quotient_result(const Approximate& numerator,
                                                  const Approximate& denominator,
                                                  const Range& range) {
  const double size = std::abs(denominator.value);
  if (!(size > 4 * denominator.error)) return {.certainty = Certainty::unsure};
  const double t = numerator.value / denominator.value;
  const double error = (numerator.error + std::abs(t) * denominator.error) /
                           (size - denominator.error) * (1 + gamma(16)) +
                       std::abs(t) * gamma(kQuotientRoundings) + kUnderflow;
  const double lo = t - error, hi = t + error;
  if (hi < range.t_min || lo > range.t_max) return {.certainty = Certainty::miss};
  const bool within = lo >= range.t_min && hi <= range.t_max;
  return {.certainty = within ? Certainty::hit : Certainty::unsure, .lo = lo, .hi = hi};
}

}  // namespace microtrace
