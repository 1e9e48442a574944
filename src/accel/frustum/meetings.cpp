#include "accel/frustum/meetings.hpp"

#include "accel/build/references/shape_box.hpp"
#include "accel/filters/triangle_filter.hpp"

#include <algorithm>
#include <cmath>

namespace microtrace {
namespace {

using Kind = Meeting::Kind;

/// Exceeds the relative errors of all formulas here that are not sums of terms with different
/// signs.
constexpr double kRelative = 0x1p-40;

/// Rays meet a plane at t = height / slope.
Meeting quotient(double height, double error, Interval slope) {
  if (slope.hi < 0) {
    height = -height;
    slope = {.lo = -slope.hi, .hi = -slope.lo};
  }
  if (!(slope.lo > 0)) return {};
  if (height < -error) return {.kind = Kind::none};
  if (!(height > error)) return {};
  return {.kind = Kind::all,
          .t = {.lo = (height - error) / slope.hi * (1 - kRelative),
                .hi = (height + error) / slope.lo * (1 + kRelative)}};
}

/// The plane through a point, given relative to the rays' origin. `n` and `size` are as in
/// Directions::along.
Meeting plane_meeting(const Directions& directions, const DVec3& point, const DVec3& n,
                      const DVec3& size) {
  return quotient(glm::dot(n, point), 0x1p-48 * glm::dot(size, glm::abs(point)),
                  directions.along(n, size));
}

}  // namespace

Meeting meeting(const Directions& directions, const Vec3& o, const Plane& plane) {
  const DVec3 n(plane.normal);
  return plane_meeting(directions, DVec3(plane.point) - DVec3(o), n, glm::abs(n));
}

Meeting meeting(const Directions& directions, const Vec3& o, const Disc& disc) {
  Meeting result = meeting(directions, o, Plane{.point = disc.center, .normal = disc.normal});
  if (result.kind == Kind::all) result.kind = Kind::unknown;
  return result;
}

Meeting meeting(const Directions& directions, const Vec3& o, const Triangle& triangle) {
  const DVec3 a = DVec3(triangle.a) - DVec3(o), b = DVec3(triangle.b) - DVec3(o),
              c = DVec3(triangle.c) - DVec3(o);
  // The edge functions of TriangleFilter.
  int positive = 0, negative = 0;
  for (const CrossProduct& edge : {CrossProduct(b, c), CrossProduct(c, a), CrossProduct(a, b)}) {
    const Interval w = directions.along(edge.value, edge.permanent);
    positive += w.lo > 0 ? 1 : 0;
    negative += w.hi < 0 ? 1 : 0;
  }
  if (positive > 0 && negative > 0) return {.kind = Kind::none};
  const CrossProduct n(DVec3(triangle.b) - DVec3(triangle.a),
                       DVec3(triangle.c) - DVec3(triangle.a));
  Meeting result = plane_meeting(directions, a, n.value, n.permanent);
  if (result.kind == Kind::all && positive != 3 && negative != 3) result.kind = Kind::unknown;
  return result;
}

Meeting meeting(const Directions& directions, const Vec3& o, const Sphere& sphere) {
  if (build::is_empty(sphere)) return {.kind = Kind::none};
  // As in SphereFilter, but with the smaller root t = c / (-b + s), where c = m.m - r^2 and s is
  // the root of the discriminant.
  const DVec3 m = DVec3(o) - DVec3(sphere.center);
  const double distance = glm::length(m), r = sphere.radius;
  const double c = (distance - r) * (distance + r);
  if (!(distance * (1 - kRelative) > r * (1 + kRelative))) return {};
  const Interval lengths = directions.lengths();
  const double most = r * lengths.hi * (1 + kRelative);
  const Interval v = directions.cross_length(m, most * (1 + 2 * kRelative));
  if (v.lo * (1 - kRelative) > most) return {.kind = Kind::none};
  const Interval b = directions.along(m, glm::abs(m));
  if (b.lo > 0) return {.kind = Kind::none};
  Meeting result;
  // No point of the sphere is nearer than this.
  result.t.lo = (distance - r) / lengths.hi * (1 - kRelative);
  const double least = r * lengths.lo * (1 - kRelative);
  if (!(b.hi < 0) || !(v.hi * (1 + kRelative) < least)) return result;
  const Interval root{.lo = std::sqrt((least - v.hi) * (least + v.hi)),
                      .hi = std::sqrt((most - v.lo) * (most + v.lo))};
  // c is a product of a sum and a difference whose errors are at most 2^-50 times the distance.
  const double error = 0x1p-48 * distance * distance;
  result.t.lo = std::max(result.t.lo, (c - error) / (root.hi - b.lo) * (1 - kRelative));
  result.t.hi = (c + error) / (root.lo - b.hi) * (1 + kRelative);
  result.kind = Kind::all;
  return result;
}

Meeting meeting(const Directions&, const Vec3&, const Quadric&) {
  return {};
}

}  // namespace microtrace
