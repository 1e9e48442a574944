#pragma once
/// Selects the filter for each shape, and checks the conditions under which the filter may be used.

#include "accel/filters/planar_filter.hpp"
#include "accel/filters/quadratic_filter.hpp"
#include "accel/filters/triangle_filter.hpp"

namespace microtrace {

/// The filter of a shape for single rays.
template <class Seen>
struct ShapeFilter {
  Seen shape;

  [[nodiscard]] FilterResult operator()(const DVec3& d, const Range& range) const {
    return result_of(filter(shape, d, range));
  }
};

[[nodiscard]] inline ShapeFilter<SeenSphere> seen_from(const Vec3& o, const Sphere& s) {
  return {sphere_seen_from(o, s)};
}
[[nodiscard]] inline ShapeFilter<SeenPlane> seen_from(const Vec3& o, const Plane& p) {
  return {plane_seen_from(o, p.point, p.normal)};
}
[[nodiscard]] inline ShapeFilter<SeenDisc> seen_from(const Vec3& o, const Disc& d) {
  return {disc_seen_from(o, d)};
}
[[nodiscard]] inline TriangleFilter seen_from(const Vec3& o, const Triangle& t) {
  return {t, o};
}
[[nodiscard]] inline ShapeFilter<SeenQuadric> seen_from(const Vec3& o, const Quadric& q) {
  return {quadric_seen_from(o, q)};
}

/// Also false for negative radii, because such spheres are empty but the filter squares the radius.
[[nodiscard]] inline bool is_filterable(const Sphere& s) {
  return is_filterable(s.center) && is_filterable(s.radius) && s.radius >= 0;
}
[[nodiscard]] inline bool is_filterable(const Plane& p) {
  return is_filterable(p.point) && is_filterable(p.normal);
}
[[nodiscard]] inline bool is_filterable(const Disc& d) {
  return is_filterable(d.center) && is_filterable(d.normal) && is_filterable(d.radius) &&
         d.radius >= 0;
}
[[nodiscard]] inline bool is_filterable(const Triangle& t) {
  return is_filterable(t.a) && is_filterable(t.b) && is_filterable(t.c);
}
[[nodiscard]] inline bool is_filterable(const Quadric& q) {
  return is_filterable(Vec3(q.a, q.b, q.c)) && is_filterable(Vec3(q.d, q.e, q.f)) &&
         is_filterable(Vec3(q.g, q.h, q.i)) && is_filterable(q.j);
}

}  // namespace microtrace
