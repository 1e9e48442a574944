#pragma once
/// Solvers in float64 for polynomials and increasing functions.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace microtrace {

/// A lower bound of the least positive root of the polynomial c[0] + c[1] x + c[2] x^2 + ... with
/// c[0] > 0; infinity if there is no such root. The bound is tight except for rounding errors. A
/// local minimum that rounding can't distinguish from 0 counts as a root.
[[nodiscard]] double least_positive_root(const std::vector<double>& c);

/// The value and the derivative of a function.
struct ValueAndSlope {
  double value, slope;
};

/// Solves f(x) = y for an increasing function on [lo, hi], as precisely as rounding allows. Uses
/// Newton's method, with bisection where Newton's method converges slowly. f(x) returns a
/// ValueAndSlope.
template <class F>
double solve_increasing(const F& f, double y, double lo, double hi) {
  // A relative error below this is accepted once it stops decreasing.
  constexpr double kRounding = 1e-13;
  double x = std::clamp(y, lo, hi), last_step = hi - lo;
  double best = x, least_error = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 200; ++i) {  // the interval is halved at least every other time
    const auto [value, slope] = f(x);
    const double error = value - y;
    if (std::abs(error) < least_error) {
      best = x;
      least_error = std::abs(error);
    } else if (least_error <= kRounding * std::abs(y)) {
      break;
    }
    (error > 0 ? hi : lo) = x;
    double step = -error / slope;
    const double next = x + step;
    if (!(next >= lo && next <= hi && std::abs(step) <= last_step / 2)) step = (lo + hi) / 2 - x;
    if (x + step == x) break;
    last_step = std::abs(step);
    x += step;
  }
  return best;
}

}  // namespace microtrace
