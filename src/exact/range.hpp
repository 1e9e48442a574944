#pragma once
/// Functions that several shapes share: tests whether a hit lies in the ray's closed interval, and
/// the roots of a quadratic polynomial.

#include "base/finite.hpp"
#include "exact/numbers/root.hpp"

#include <microtrace/ray.hpp>

#include <optional>

namespace microtrace::exact {

/// Returns true if t_min <= t <= t_max.
[[nodiscard]] bool in_range(const Root& t, const Ray& ray);

/// Returns t if it is in the ray's interval, otherwise nothing.
[[nodiscard]] std::optional<Root> first_in_range(const Root& t, const Ray& ray);

/// Returns the least number that is in both [lo, hi] and [t_min, t_max], or nothing if there is
/// none.
[[nodiscard]] std::optional<Root> first_in_range(const Root& lo, const Root& hi, const Ray& ray);

struct RootPair {
  Root lo, hi;  ///< lo <= hi
};

/// Returns the real roots of a t^2 + 2 b t + c, or nothing if there are none. a must not be zero.
[[nodiscard]] std::optional<RootPair> quadratic_roots(const Dyadic& a, const Dyadic& b,
                                                      const Dyadic& c);

}  // namespace microtrace::exact
