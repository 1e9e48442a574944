#pragma once
#include "accel/filters/filter.hpp"

#include <microtrace/shape.hpp>

#include <array>

#include <glm/geometric.hpp>

namespace microtrace {

/// A triangle seen from o. With A = a - o, B = b - o, C = c - o the signs of
/// w_a = d.(B x C), w_b = d.(C x A), w_c = d.(A x B) say on which side of its edges the ray passes,
/// and t = (A.n) / (d.n) with n = (b - a) x (c - a). Two strictly opposite signs are a miss; three
/// equal ones a crossing of the triangle's plane within it.
class TriangleFilter {
 public:
  TriangleFilter(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& o) {
    const DVec3 p = a, q = b, r = c;
    const DVec3 from_a = p - DVec3(o), from_b = q - DVec3(o), from_c = r - DVec3(o);
    edges_ = {cross(from_b, from_c), cross(from_c, from_a), cross(from_a, from_b)};
    normal_ = cross(q - p, r - p);
    // A one rounding, n four of its own, the product one, the sum two.
    height_ = {.value = glm::dot(from_a, normal_.value),
               .error = gamma(9) * glm::dot(glm::abs(from_a), normal_.permanent) + kUnderflow};
  }
  TriangleFilter(const Triangle& triangle, const Vec3& o)
      : TriangleFilter(triangle.a, triangle.b, triangle.c, o) {}

  [[nodiscard]] Verdict operator()(const DVec3& d, const Range& range) const {
    bool inside_positive = true, inside_negative = true, any_positive = false, any_negative = false;
    for (const Cross& edge : edges_) {
      const Approximate w = along(d, edge);
      any_positive |= w.is_positive();
      any_negative |= w.is_negative();
      inside_positive &= w.is_positive();
      inside_negative &= w.is_negative();
    }
    if (any_positive && any_negative) return {.certainty = Certainty::miss};
    Verdict crossing = quotient_verdict(height_, along(d, normal_), range);
    if (crossing.certainty == Certainty::hit && !inside_positive && !inside_negative)
      crossing.certainty = Certainty::unsure;
    return crossing;
  }

 private:
  struct Cross {
    DVec3 value, permanent;
  };

  // The factors have one rounding each; with product and difference a component has four.
  static Cross cross(const DVec3& x, const DVec3& y) {
    const DVec3 left(x.y * y.z, x.z * y.x, x.x * y.y), right(x.z * y.y, x.x * y.z, x.y * y.x);
    return {.value = left - right, .permanent = glm::abs(left) + glm::abs(right)};
  }

  // Four roundings from the cross product, one from the product with d (itself exact), two from the
  // sum.
  static Approximate along(const DVec3& d, const Cross& cross) {
    return {.value = glm::dot(d, cross.value),
            .error = gamma(8) * glm::dot(glm::abs(d), cross.permanent) + kUnderflow};
  }

  std::array<Cross, 3> edges_;
  Cross normal_;
  Approximate height_{};
};

}  // namespace microtrace
