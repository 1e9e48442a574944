#pragma once
/// Tests in float64 whether a small box is clear of surfaces.

#include "accel/filters/shape_filter.hpp"
#include "accel/spawn/origin_search.hpp"

#include <microtrace/shape.hpp>

#include <cmath>
#include <optional>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {

inline CrossProduct normal_of(const Triangle& t) {
  return {DVec3(t.b) - DVec3(t.a), DVec3(t.c) - DVec3(t.a)};
}

/// Returns twice the signed area of the triangle a b x projected along an axis. The error bound
/// covers all points x in the box p +- radius.
inline Approximate area_along(int axis, const Vec3& a, const Vec3& b, const DVec3& p,
                              const DVec3& radius) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const DVec3 edge = DVec3(b) - DVec3(a), from_a = p - DVec3(a);
  const double left = edge[i] * from_a[j], right = edge[j] * from_a[i];
  // Each factor has one rounding, the products have one, and the difference has one. The term for
  // the change within the box has four roundings of second order, for which 1 + gamma(4) would
  // suffice.
  return {
      .value = left - right,
      .error = gamma(4) * (std::abs(left) + std::abs(right)) +
               (1 + gamma(8)) * (radius[j] * std::abs(edge[i]) + radius[i] * std::abs(edge[j])) +
               kUnderflow};
}

/// Returns true if, projected along some axis, the whole box p +- radius is certainly left of one
/// edge of the triangle and right of another. The triangle may have zero area.
inline bool is_beside_segment(const Triangle& t, const DVec3& p, const DVec3& radius) {
  for (int axis = 0; axis < 3; ++axis) {
    bool any_positive = false, any_negative = false;
    for (const auto& [a, b] : {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)}) {
      const Approximate area = area_along(axis, a, b, p, radius);
      any_positive |= area.is_positive();
      any_negative |= area.is_negative();
    }
    if (any_positive && any_negative) return true;
  }
  return false;
}

/// Returns true if, projected along the axis nearest to the triangle's normal, the whole box p +-
/// radius is certainly outside the triangle. This decides most coplanar triangles.
inline bool is_beside(const Triangle& t, const CrossProduct& normal, const DVec3& p,
                      const DVec3& radius) {
  const DVec3 size = glm::abs(normal.value);
  const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  // The normal has four roundings, so half of this bound would suffice.
  if (!(size[axis] > 2 * gamma(4) * normal.permanent[axis] + kUnderflow))
    return is_beside_segment(t, p, radius);
  const bool positive = normal.value[axis] > 0;
  const auto is_outside = [&](const Vec3& a, const Vec3& b) {
    const Approximate area = area_along(axis, a, b, p, radius);
    return positive ? area.is_negative() : area.is_positive();
  };
  return is_outside(t.a, t.b) || is_outside(t.b, t.c) || is_outside(t.c, t.a);
}

/// Returns |x - center|^2 - r^2, with an error bound that covers all x in the box p +- radius.
inline Approximate ball_value(const Vec3& center, float r, const DVec3& p, const DVec3& radius) {
  const DVec3 from_center = p - DVec3(center), size = glm::abs(from_center);
  const double square = glm::dot(from_center, from_center), r2 = double{r} * r;
  // The vector has two roundings, the sum of squares adds three, and the difference adds one. The
  // seventh covers the roundings of the change within the box, which is at most radius . (2 |x -
  // center| + radius).
  return {.value = square - r2,
          .error = gamma(7) * (square + r2) + 2 * glm::dot(radius, size + radius) + kUnderflow};
}

/// An axis-aligned plane, such as a floor or a wall.
struct AxisPlane {
  int axis;
  float at;

  /// Returns the plane through a if it is axis-aligned. normal_permanent is the permanent of its
  /// normal.
  static std::optional<AxisPlane> of(const Vec3& a, const DVec3& normal_permanent) {
    for (int k = 0; k < 3; ++k) {
      if (normal_permanent[(k + 1) % 3] == 0 && normal_permanent[(k + 2) % 3] == 0)
        return AxisPlane{.axis = k, .at = a[k]};
    }
    return std::nullopt;
  }
};

// Returns true if a surface lies within the plane.

inline bool lies_in(const AxisPlane& plane, const Triangle& t) {
  const int k = plane.axis;
  return t.a[k] == plane.at && t.b[k] == plane.at && t.c[k] == plane.at;
}
inline bool lies_in(const AxisPlane& plane, const Plane& s) {
  const auto own = AxisPlane::of(s.point, DVec3(s.normal));
  return own && own->axis == plane.axis && own->at == plane.at;
}
inline bool lies_in(const AxisPlane& plane, const Disc& s) {
  return lies_in(plane, Plane{.point = s.center, .normal = s.normal});
}
inline bool lies_in(const AxisPlane&, const Sphere&) {
  return false;
}
inline bool lies_in(const AxisPlane&, const Quadric&) {
  return false;
}

// Returns true if the surface certainly doesn't meet any segment between two points of the box p +-
// radius.

inline bool clears_box(const Triangle& t, const DVec3& p, const DVec3& radius) {
  const CrossProduct normal = normal_of(t);
  return certain_side(t.a, normal, p, radius) != 0 || is_beside(t, normal, p, radius);
}
inline bool clears_box(const Plane& s, const DVec3& p, const DVec3& radius) {
  return certain_side(s.point, CrossProduct(DVec3(s.normal)), p, radius) != 0;
}
inline bool clears_box(const Disc& s, const DVec3& p, const DVec3& radius) {
  return certain_side(s.center, CrossProduct(DVec3(s.normal)), p, radius) != 0;
}
inline bool clears_box(const Sphere& s, const DVec3& p, const DVec3& radius) {
  const Approximate f = ball_value(s.center, s.radius, p, radius);
  return f.is_positive() || f.is_negative();
}
inline bool clears_box(const Quadric& q, const DVec3& p, const DVec3& radius) {
  const DVec3 squares(q.a, q.b, q.c), mixed(q.f, q.e, q.d), linear(q.g, q.h, q.i);
  const auto form = [](const DVec3& s, const DVec3& m, const DVec3& x) {
    return s.x * x.x * x.x + s.y * x.y * x.y + s.z * x.z * x.z + m.z * x.x * x.y + m.y * x.x * x.z +
           m.x * x.y * x.z;
  };
  const double value = form(squares, mixed, p) + glm::dot(linear, p) + double{q.j};
  // The growth of the polynomial with all coefficients and coordinates replaced by their magnitudes
  // bounds its change within the box. The value has nine roundings: one of products and eight of
  // sums (five in the form, two in the dot product, one of both together; the last is of second
  // order). If the value is near zero, a partial sum is at most half of the permanent, so at most
  // four roundings matter. The fifth, and 1 + gamma(16), cover second-order terms and a value as
  // large as the growth.
  const DVec3 size = glm::abs(p), a = glm::abs(squares), m = glm::abs(mixed), l = glm::abs(linear);
  const DVec3 gradient(2 * a.x * size.x + m.z * size.y + m.y * size.z + l.x,
                       2 * a.y * size.y + m.z * size.x + m.x * size.z + l.y,
                       2 * a.z * size.z + m.y * size.x + m.x * size.y + l.z);
  const double growth = glm::dot(gradient, radius) + form(a, m, radius);
  const double permanent = form(a, m, size) + glm::dot(l, size) + std::abs(double{q.j});
  return std::abs(value) > growth * (1 + gamma(16)) + gamma(5) * permanent + kUnderflow;
}

}  // namespace microtrace
