#include "exact/range.hpp"

#include "exact/first_hit.hpp"

#include <cmath>

namespace microtrace::exact {

bool is_valid(const Ray& ray) {
  return is_finite(ray.o) && is_finite(ray.d) && (ray.d.x != 0 || ray.d.y != 0 || ray.d.z != 0) &&
         std::isfinite(ray.t_min) && 0 <= ray.t_min && ray.t_min <= ray.t_max;
}

bool in_range(const Root& t, const Ray& ray) {
  return t >= rational(ray.t_min) && (std::isinf(ray.t_max) || t <= rational(ray.t_max));
}

std::optional<Root> first_in_range(const Root& t, const Ray& ray) {
  if (!in_range(t, ray)) return std::nullopt;
  return t;
}

std::optional<Root> first_in_range(const Root& lo, const Root& hi, const Ray& ray) {
  const Root t_min = rational(ray.t_min);
  if (hi < t_min) return std::nullopt;
  return first_in_range(lo < t_min ? t_min : lo, ray);
}

std::optional<RootPair> quadratic_roots(const Dyadic& a, const Dyadic& b, const Dyadic& c) {
  const Dyadic discriminant = square(b) - a * c;
  if (discriminant.sign() < 0) return std::nullopt;
  const int sign = discriminant.sign();
  // (-b +- sqrt(discriminant)) / a, with a positive denominator.
  if (a.sign() < 0) return RootPair{{b, discriminant, -a, -sign}, {b, discriminant, -a, sign}};
  return RootPair{{-b, discriminant, a, -sign}, {-b, discriminant, a, sign}};
}

}  // namespace microtrace::exact
