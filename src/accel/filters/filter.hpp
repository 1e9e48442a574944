#pragma once
/// Floating-point filters: each decides a hit in float64 with a proven error bound, or reports that
/// it can't.
///
/// A filter is a shape seen from one origin o: terms that depend only on o are computed once (for
/// all rays of a camera), then each direction takes a few multiplications. The constructors take
/// float32 data. Every bound below counts roundings as Higham does (Accuracy and Stability of
/// Numerical Algorithms, 2002, section 3.1): a sum of products in which each term has at most k
/// roundings has an error of at most gamma_k = k U / (1 - k U) times the sum of the terms'
/// magnitudes, called its "permanent". tests/property/bounds has inputs that need these counts.

#include "accel/filters/roundings.hpp"

#include <microtrace/math.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace microtrace {

/// Within this limit no intermediate result overflows, and underflow adds less than kUnderflow to a
/// form of degree six: a few hundred times 2^-1075 times at most 2^(6 * 64). Larger coordinates are
/// left to exact arithmetic.
inline constexpr float kLargestCoordinate = 0x1p64F;

[[nodiscard]] constexpr double gamma(double roundings) {
  return roundings * kRounding;
}

enum class Certainty { miss, hit, unsure };

/// The result of a filter. Unless it is a miss, lo is below the exact t of the hit; if the hit is
/// certain, hi is above it.
struct FilterResult {
  Certainty certainty = Certainty::miss;
  double lo = -std::numeric_limits<double>::infinity();
  double hi = std::numeric_limits<double>::infinity();
};

/// The closed interval in which a ray looks for hits.
struct Range {
  double t_min, t_max;
};

/// A rounded number and a bound of its error.
struct Approximate {
  double value, error;

  [[nodiscard]] bool is_positive() const { return value > error; }
  [[nodiscard]] bool is_negative() const { return value < -error; }
};

/// The sum of x_i y_i. Each product has at most `roundings` roundings, including those before this
/// function and the two of the sum.
[[nodiscard]] inline Approximate dot_product(const DVec3& x, const DVec3& y, int roundings) {
  const double a = x.x * y.x, b = x.y * y.y, c = x.z * y.z;
  return {.value = a + b + c,
          .error = gamma(roundings) * (std::abs(a) + std::abs(b) + std::abs(c)) + kUnderflow};
}

/// Whether a number is within the filters' limit; false for NaN.
[[nodiscard]] inline bool is_filterable(float x) {
  return std::abs(x) <= kLargestCoordinate;
}
[[nodiscard]] inline bool is_filterable(const Vec3& v) {
  return is_filterable(v.x) && is_filterable(v.y) && is_filterable(v.z);
}

/// The interval of numerator / denominator, compared with the range. The quotient q of the rounded
/// parts satisfies |q - q*| <= (error_n + |q| error_d) / (|d| - error_d). The bound itself has
/// eight roundings of second order, for which 1 + gamma(8) would suffice. Any |d| above its error
/// would be valid; requiring four times the error keeps lo and hi close.
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
