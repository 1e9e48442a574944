#include "exact/planar.hpp"

#include "exact/first_hit.hpp"
#include "exact/numbers/vector.hpp"
#include "exact/queries.hpp"
#include "exact/range.hpp"

#include <cmath>

namespace microtrace::exact {
namespace {

bool is_normal(const Vec3& n) {
  return is_finite(n) && (n.x != 0 || n.y != 0 || n.z != 0);
}

}  // namespace

bool is_empty(const Plane& plane) {
  return !is_finite(plane.point) || !is_normal(plane.normal);
}

bool is_empty(const Disc& disc) {
  return !is_finite(disc.center) || !is_normal(disc.normal) || !std::isfinite(disc.radius) ||
         disc.radius < 0;
}

Dyadic squared_offset(const Disc& disc, const Ray& ray, const Dyadic& distance,
                      const Dyadic& speed) {
  const Vector m = vector(ray.o) - vector(disc.center);
  const Vector offset = speed * m + distance * vector(ray.d);
  return dot(offset, offset);
}

std::optional<Root> first_hit(const Plane& plane, const Ray& ray) {
  ++queries.dyadic;
  if (!is_valid(ray) || is_empty(plane)) return std::nullopt;
  const Vector n = vector(plane.normal);
  const Dyadic distance = dot(n, vector(plane.point) - vector(ray.o));
  const Dyadic speed = dot(n, vector(ray.d));
  if (speed.sign() != 0) return first_in_range(rational(distance, speed), ray);
  if (distance.sign() != 0) return std::nullopt;
  return rational(ray.t_min);
}

std::optional<Root> first_hit(const Disc& disc, const Ray& ray) {
  ++queries.dyadic;
  if (!is_valid(ray) || is_empty(disc)) return std::nullopt;
  const Vector n = vector(disc.normal), d = vector(ray.d);
  const Vector m = vector(ray.o) - vector(disc.center);
  const Dyadic r_squared = square(disc.radius);
  const Dyadic distance = -dot(n, m);
  const Dyadic speed = dot(n, d);
  if (speed.sign() != 0) {
    // Tests |m + (distance / speed) d| <= r, multiplied by |speed| and squared.
    if (compare(squared_offset(disc, ray, distance, speed), r_squared * square(speed)) > 0)
      return std::nullopt;
    return first_in_range(rational(distance, speed), ray);
  }
  if (distance.sign() != 0) return std::nullopt;
  // The ray lies in the plane. The disc then contains the part of the line that lies in the ball
  // with the same center and radius.
  const auto roots = quadratic_roots(dot(d, d), dot(d, m), dot(m, m) - r_squared);
  if (!roots) return std::nullopt;
  return first_in_range(roots->lo, roots->hi, ray);
}

}  // namespace microtrace::exact
