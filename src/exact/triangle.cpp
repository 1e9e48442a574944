#include "exact/first_hit.hpp"
#include "exact/flat.hpp"
#include "exact/queries.hpp"
#include "exact/range.hpp"

namespace microtrace::exact {

bool is_empty(const Triangle& triangle) {
  return !is_finite(triangle.a) || !is_finite(triangle.b) || !is_finite(triangle.c);
}

std::optional<Root> first_hit(const Triangle& triangle, const Ray& ray) {
  ++queries.dyadic;
  if (!is_valid(ray) || is_empty(triangle)) return std::nullopt;
  const Vector o = vector(ray.o);
  const auto stretch = meet(
      vector(ray.d),
      CornersOf<Dyadic>{vector(triangle.a) - o, vector(triangle.b) - o, vector(triangle.c) - o});
  if (!stretch) return std::nullopt;
  if (stretch->is_point) return first_in_range(rational(stretch->lo), ray);
  return first_in_range(rational(stretch->lo), rational(stretch->hi), ray);
}

}  // namespace microtrace::exact
