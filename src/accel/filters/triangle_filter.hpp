#pragma once
#include "accel/filters/filter.hpp"

#include <microtrace/shape.hpp>

#include <algorithm>
#include <array>
#include <functional>

#include <glm/geometric.hpp>

namespace microtrace {

/// A cross product and, for each component, the sum of the magnitudes of its two terms. If the
/// components of both factors have one rounding each, a component of the product has four.
struct CrossProduct {
  DVec3 value, permanent;

  CrossProduct(const DVec3& x, const DVec3& y) {
    const DVec3 left(x.y * y.z, x.z * y.x, x.x * y.y), right(x.z * y.y, x.x * y.z, x.y * y.x);
    value = left - right;
    permanent = glm::abs(left) + glm::abs(right);
  }

  /// Wraps an exact vector as a cross product without error.
  explicit CrossProduct(const DVec3& exact) : value(exact), permanent(glm::abs(exact)) {}

  /// Returns the dot product with an exact vector d. Its kSlopeRoundings are the four above, one of
  /// the product and two of the sum.
  [[nodiscard]] Approximate along(const DVec3& d) const {
    return {.value = glm::dot(d, value),
            .error = gamma(kSlopeRoundings) * glm::dot(glm::abs(d), permanent) + kUnderflow};
  }
};

/// The plane of a triangle relative to the ray origin o: t = (A.n) / (d.n) with A = a - o and n =
/// (b - a) x (c - a).
class TrianglePlaneFilter {
 public:
  TrianglePlaneFilter(const Triangle& triangle, const Vec3& o)
      : normal_(DVec3(triangle.b) - DVec3(triangle.a), DVec3(triangle.c) - DVec3(triangle.a)) {
    const DVec3 from_a = DVec3(triangle.a) - DVec3(o);
    // The kHeightRoundings are one of A, four of n, one of the product and two of the sum.
    height_ = {.value = glm::dot(from_a, normal_.value),
               .error = gamma(kHeightRoundings) * glm::dot(glm::abs(from_a), normal_.permanent) +
                        kUnderflow};
  }

  [[nodiscard]] FilterResult operator()(const DVec3& d, const Range& range) const {
    return result_of(quotient_result(height_, normal_.along(d), range));
  }

 private:
  CrossProduct normal_;
  Approximate height_{};
};

/// A triangle relative to the ray origin o. With A = a - o, B = b - o, C = c - o, the signs of w_a
/// = d.(B x C), w_b = d.(C x A), w_c = d.(A x B) tell on which side of each edge the ray passes. If
/// two signs are strictly opposite, the ray misses. If all three are strictly equal, the ray's line
/// meets the plane inside the triangle.
class TriangleFilter {
 public:
  TriangleFilter(const Triangle& triangle, const Vec3& o)
      : TriangleFilter(triangle, o, DVec3(triangle.a) - DVec3(o), DVec3(triangle.b) - DVec3(o),
                       DVec3(triangle.c) - DVec3(o)) {}

  [[nodiscard]] FilterResult operator()(const DVec3& d, const Range& range) const {
    bool inside_positive = true, inside_negative = true, any_positive = false, any_negative = false;
    for (const CrossProduct& edge : edges_) {
      const Approximate w = edge.along(d);
      any_positive |= w.is_positive() != 0;
      any_negative |= w.is_negative() != 0;
      inside_positive &= w.is_positive() != 0;
      inside_negative &= w.is_negative() != 0;
    }
    if (any_positive && any_negative) return {.certainty = Certainty::miss};
    FilterResult crossing = plane_(d, range);
    if (crossing.certainty == Certainty::hit && !inside_positive && !inside_negative)
      crossing.certainty = Certainty::unsure;
    if (crossing.certainty == Certainty::unsure && misses_projected(d))
      return {.certainty = Certainty::miss};
    return crossing;
  }

 private:
  /// True if, for some axis, that component of d x A, d x B and d x C certainly has the same sign
  /// for all three vertices. Projected along d, the ray is then outside the triangle. The test also
  /// works for triangles of zero area and triangles whose plane contains the ray.
  [[nodiscard]] bool misses_projected(const DVec3& d) const {
    std::array<bool, 3> all_positive{true, true, true}, all_negative = all_positive;
    for (const DVec3& corner : corners_) {
      // A and the product have one rounding each. The rounding of the difference never changes its
      // sign.
      const CrossProduct side(d, corner);
      for (int i = 0; i < 3; ++i) {
        const Approximate x{.value = side.value[i],
                            .error = gamma(3) * side.permanent[i] + kUnderflow};
        all_positive[static_cast<std::size_t>(i)] &= x.is_positive() != 0;
        all_negative[static_cast<std::size_t>(i)] &= x.is_negative() != 0;
      }
    }
    return std::ranges::any_of(all_positive, std::identity{}) ||
           std::ranges::any_of(all_negative, std::identity{});
  }

  TriangleFilter(const Triangle& triangle, const Vec3& o, const DVec3& a, const DVec3& b,
                 const DVec3& c)
      : corners_{a, b, c},
        edges_{CrossProduct(b, c), CrossProduct(c, a), CrossProduct(a, b)},
        plane_(triangle, o) {}

  std::array<DVec3, 3> corners_;  // A, B, C
  std::array<CrossProduct, 3> edges_;
  TrianglePlaneFilter plane_;
};

}  // namespace microtrace
