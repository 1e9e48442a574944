#pragma once
/// Rounds exact numbers to float64, for display and for points on surfaces. Decisions about hits
/// never depend on the results.

#include "exact/numbers/root.hpp"

namespace microtrace::exact {

/// Returns the float64 nearest to t, ties to even; infinite if |t| exceeds float64.
[[nodiscard]] double round_to_double(const Root& t);

/// Returns the float64 nearest to x, ties to even; infinite if |x| exceeds float64.
[[nodiscard]] inline double round_to_double(const Dyadic& x) {
  return round_to_double(rational(x, 1.0F));
}

}  // namespace microtrace::exact
