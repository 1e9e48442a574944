#pragma once
/// Steps shared by all shapes: validity, the ray's closed interval, roots of a quadratic
/// polynomial.

#include "exact/numbers/root.hpp"

#include <microtrace/ray.hpp>

#include <optional>

namespace microtrace::exact {

[[nodiscard]] bool is_finite(const Vec3& v);

/// True if t_min <= t <= t_max.
[[nodiscard]] bool in_range(const Root& t, const Ray& ray);

/// t itself if it is in range.
[[nodiscard]] std::optional<Root> first_in_range(const Root& t, const Ray& ray);

/// The least number in both [lo, hi] and [t_min, t_max].
[[nodiscard]] std::optional<Root> first_in_range(const Root& lo, const Root& hi, const Ray& ray);

struct RootPair {
  Root lo, hi;  ///< lo <= hi
};

/// The real roots of a t^2 + 2 b t + c, a not zero; nothing if there are none.
[[nodiscard]] std::optional<RootPair> quadratic_roots(const Dyadic& a, const Dyadic& b,
                                                      const Dyadic& c);

}  // namespace microtrace::exact
