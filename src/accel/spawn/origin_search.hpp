#pragma once
/// The parts of the search for the origin of a ray that leaves a surface. docs/exactness.md proves
/// that the search succeeds.

#include "accel/filters/shape_filter.hpp"
#include "exact/first_hit.hpp"
#include "exact/implicit.hpp"
#include "exact/range.hpp"
#include "exact/triangle_hit.hpp"

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {

/// Returns the distance from |x| to the next larger float32. The rounding error of a number that
/// was rounded to x is at most half of this distance.
inline double spacing(float x) {
  const std::uint32_t exponent = std::bit_cast<std::uint32_t>(x) >> 23U & 255U;
  // 2^(exponent - 150), which is far above the least float64 number.
  return std::bit_cast<double>(std::uint64_t{std::max(exponent, 1U) + 1023 - 150} << 52U);
}

/// Replaces -0 by 0, because origins have no coordinate of -0.
inline float unsigned_zero(float x) {
  return x + 0.0F;
}
inline Vec3 unsigned_zeros(const Vec3& v) {
  return v + Vec3(0.0F);
}

/// Returns the next float32 above x if `up`, otherwise below x. x must be finite.
inline float neighbor(float x, bool up) {
  if (x == 0)
    return up ? std::numeric_limits<float>::denorm_min()
              : -std::numeric_limits<float>::denorm_min();
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return unsigned_zero(std::bit_cast<float>((x > 0) == up ? bits + 1 : bits - 1));
}

/// A step that moves an origin off a surface, by moving one coordinate to the next float32.
struct OriginStep {
  int axis;
  bool up;

  void apply(Vec3& p) const { p[axis] = neighbor(p[axis], up); }
};

/// Returns the step that increases the surface's function most. v is the gradient of this function
/// or a substitute.
[[nodiscard]] inline OriginStep best_step(const Vec3& p, const DVec3& v) {
  int best = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(v[k]) * spacing(p[k]) > std::abs(v[best]) * spacing(p[best])) best = k;
  }
  return {.axis = best, .up = !(v[best] < 0)};
}

inline DVec3 gradient_of(const exact::Implicit& f, const Vec3& p) {
  DVec3 g{0};
  for (int k = 0; k < 3; ++k) {
    Vec3 e{0};
    e[k] = 1;
    g[k] = exact::to_double(f.slope(exact::vector(p), exact::vector(e)));
  }
  return g;
}

/// Returns true if p is on the given side, and if a ray from p has as many zeros of F ahead as a
/// ray from the surface itself: one if F returns to zero, otherwise none.
inline bool is_clear_of(const exact::Implicit& f, const Vec3& p, const Vec3& direction, int side) {
  if (f.value(exact::vector(p)).sign() != side) return false;
  const bool returns = f.quadratic(exact::vector(direction)).sign() * side < 0;
  return f.zeros_ahead(p, direction) == (returns ? 1 : 0);
}

/// Answers queries about a surface by exact arithmetic. point() must be called first.
template <class AnyShape>
class ExactSurface {
 public:
  explicit ExactSurface(const AnyShape& shape) : shape_(shape) {}

  /// Returns the rounded hit point, or nothing if there is no hit.
  std::optional<Vec3> point(const Ray& ray) {
    t_ = exact::first_hit(shape_, ray);
    if (!t_) return std::nullopt;
    f_.emplace(shape_);
    return unsigned_zeros(exact::round_point(ray, *t_));
  }
  [[nodiscard]] int side(const Ray& ray, const Vec3& direction) const {
    return f_->sign_behind(ray, *t_, direction);
  }
  [[nodiscard]] DVec3 gradient(const Vec3& p) const { return gradient_of(*f_, p); }
  [[nodiscard]] bool is_clear(const Vec3& p, const Vec3& direction, int side) const {
    return is_clear_of(*f_, p, direction, side);
  }

 private:
  const AnyShape& shape_;
  std::optional<exact::Implicit> f_;
  std::optional<exact::Root> t_;
};

/// Returns the side of the plane through a with this normal on which the whole box x +- radius
/// certainly lies: -1 or 1, or 0 if unknown. The normal is the cross product of two edges whose
/// ends are float32 vectors.
[[nodiscard]] inline int certain_side(const Vec3& a, const CrossProduct& normal, const DVec3& x,
                                      const DVec3& radius) {
  const DVec3 from_a = x - DVec3(a);
  // The first error term is as in TrianglePlaneFilter. In the second, the normal and the product
  // with the radius have eight roundings of second order, for which 1 + gamma(8) would suffice.
  const Approximate value{
      .value = glm::dot(from_a, normal.value),
      .error = gamma(kHeightRoundings) * glm::dot(glm::abs(from_a), normal.permanent) +
               (1 + gamma(16)) * glm::dot(radius, normal.permanent) + kUnderflow};
  return value.is_positive() ? 1 : value.is_negative() ? -1 : 0;
}

/// The point o + t d with an error bound per axis.
struct PointOnRay {
  DVec3 value, error;

  PointOnRay(const Ray& ray, const exact::Enclosure& t) {
    const DVec3 o(ray.o), d(ray.d), along = (t.lo + t.hi) / 2 * d;
    value = o + along;
    // Half of this bound would suffice: the exact t is within (hi - lo) / 2 of the middle, and
    // there are only four roundings. These are of the middle, the product, the sum, and the ends of
    // the interval in rounded_point().
    error = (t.hi - t.lo) * glm::abs(d) + gamma(8) * (glm::abs(o) + glm::abs(along)) +
            DVec3(kUnderflow);
  }
};

/// Returns coordinate k of a point in the plane through a, computed from the point's other two
/// coordinates:
///
///     p_k = a_k - w,   w = s / n_k,   s = sum over j != k of n_j r_j,   r = p - a.
///
/// The error of this formula is proportional to |n_j / n_k| and |p_k|, while the error of o_k + t
/// d_k grows with the ray's origin. This matters where coordinates are near 0: on floors at height
/// 0 and on walls that are tilted by an ulp.
///
/// Let P be the permanent of n, whose error is gamma_4 P, and e the error of p. The error of s is
/// the sum of |n_j| e_j + gamma_7 P_j (|r_j| + e_j): four roundings of n, one of r_j, one of the
/// product, one of the sum. The eighth in the code is for the quotient. The quotient adds |w|
/// (gamma_4 P_k) / |n_k|, the difference adds one rounding of the result, and the ends of the
/// interval add one rounding each.
///
/// Half of the following bounds would suffice: gamma(8) for w, gamma(4) for the result, gamma(16)
/// for the second order, and gamma(6) in `size`, because a small |n_k| has only three roundings.
[[nodiscard]] inline Approximate coordinate_in_plane(const Vec3& a, const CrossProduct& n,
                                                     const PointOnRay& p, int k) {
  const double size = std::abs(n.value[k]) - gamma(6) * n.permanent[k];
  if (!(size > 0)) return {.value = 0, .error = std::numeric_limits<double>::infinity()};
  double s = 0, s_error = 0;
  for (const int j : {(k + 1) % 3, (k + 2) % 3}) {
    const double r = p.value[j] - a[j], e = p.error[j];
    s += n.value[j] * r;
    s_error +=
        std::abs(n.value[j]) * e + gamma(kTermRoundings) * n.permanent[j] * (std::abs(r) + e);
  }
  const double w = s / n.value[k], value = a[k] - w;
  return {.value = value,
          .error = (s_error + gamma(8) * n.permanent[k] * std::abs(w)) / size * (1 + gamma(16)) +
                   gamma(4) * std::abs(value) + kUnderflow};
}

/// Returns the float32 to which all numbers in [lo, hi] round, if they round to the same one.
[[nodiscard]] inline std::optional<float> rounded(double lo, double hi) {
  const auto below = static_cast<float>(lo), above = static_cast<float>(hi);
  return below == above ? std::optional(unsigned_zero(below)) : std::nullopt;
}

/// Returns the point rounded to float32, if its error bounds determine the result.
[[nodiscard]] inline std::optional<Vec3> rounded_point(const PointOnRay& p) {
  Vec3 result{0};
  for (int k = 0; k < 3; ++k) {
    const auto x = rounded(p.value[k] - p.error[k], p.value[k] + p.error[k]);
    if (!x) return std::nullopt;
    result[k] = *x;
  }
  return result;
}

/// Returns the rounded point as above, for a point in the plane through a with this normal, which
/// gives additional bounds.
[[nodiscard]] inline std::optional<Vec3> rounded_point(const PointOnRay& p, const Vec3& a,
                                                       const CrossProduct& normal) {
  Vec3 result{0};
  for (int k = 0; k < 3; ++k) {
    const Approximate in_plane = coordinate_in_plane(a, normal, p, k);
    const auto x = rounded(std::max(p.value[k] - p.error[k], in_plane.value - in_plane.error),
                           std::min(p.value[k] + p.error[k], in_plane.value + in_plane.error));
    if (!x) return std::nullopt;
    result[k] = *x;
  }
  return result;
}

/// Answers queries about a triangle, by float64 if it can decide, otherwise exactly.
class TriangleSurface {
 public:
  explicit TriangleSurface(const Triangle& triangle)
      : triangle_(triangle),
        normal_(DVec3(triangle.b) - DVec3(triangle.a), DVec3(triangle.c) - DVec3(triangle.a)) {}

  std::optional<Vec3> point(const Ray& ray) {
    if (is_filterable(ray.o) && is_filterable(ray.d) && is_filterable(triangle_)) {
      const FilterResult filtered =
          seen_from(ray.o, triangle_)(DVec3(ray.d), {.t_min = ray.t_min, .t_max = ray.t_max});
      if (filtered.certainty == Certainty::miss) return std::nullopt;
      if (filtered.certainty == Certainty::hit) {
        if (const auto p = rounded_point({ray, {filtered.lo, filtered.hi}}, triangle_.a, normal_))
          return p;
      }
    }
    exact::TriangleHit hit(triangle_, ray);
    return hit.exists() ? std::optional(unsigned_zeros(hit.point())) : std::nullopt;
  }
  [[nodiscard]] int side(const Ray& /*ray*/, const Vec3& direction) const {
    const Approximate slope = normal_.along(direction);
    if (slope.is_positive() || slope.is_negative()) return slope.value > 0 ? 1 : -1;
    return plane().slope(direction);
  }
  [[nodiscard]] DVec3 gradient(const Vec3& p) const {
    double largest = 0, error = 0;
    for (int k = 0; k < 3; ++k) {
      largest = std::max(largest, std::abs(normal_.value[k]) * spacing(p[k]));
      error += gamma(5) * normal_.permanent[k] * spacing(p[k]);
    }
    // Up to this error, and even up to twice as much, the chosen axis and sign are the best or
    // equally good.
    return error <= 0x1p-9 * largest ? normal_.value : plane().normal();
  }
  // A ray that leaves a plane never returns to it, so only the side matters.
  [[nodiscard]] bool is_clear(const Vec3& p, const Vec3& /*direction*/, int side) const {
    return sign_at(p) == side;
  }
  [[nodiscard]] bool has_area() const { return plane().has_area(); }
  /// Returns the sign of the plane's function at q.
  [[nodiscard]] int sign_at(const Vec3& q) const {
    if (const int sign = certain_sign(q, DVec3(0)); sign != 0) return sign;
    return plane().side(q);
  }

  /// Returns the sign of the plane's function in the whole box x +- radius; 0 if unknown.
  [[nodiscard]] int certain_sign(const DVec3& x, const DVec3& radius) const {
    return certain_side(triangle_.a, normal_, x, radius);
  }

 private:
  [[nodiscard]] exact::TrianglePlane& plane() const {
    if (!plane_) plane_.emplace(triangle_);
    return *plane_;
  }

  const Triangle& triangle_;
  CrossProduct normal_;
  mutable std::optional<exact::TrianglePlane> plane_;  // created on first use
};

/// The start of the search for an origin.
struct OriginSearch {
  Vec3 p;           ///< the hit point with each coordinate rounded
  int side;         ///< the sign of the surface's function on the new ray's side
  bool goes_back;   ///< true if the new ray returns to the side of the incoming ray
  OriginStep step;  ///< moves a point off the surface to the new ray's side
};

/// Returns the start of the search, or nothing if there is no hit or the direction is zero or not
/// finite.
template <class Surface>
std::optional<OriginSearch> origin_search(Surface& surface, const Ray& ray, const Vec3& direction) {
  if (!is_finite(direction) || direction == Vec3(0)) return std::nullopt;
  const std::optional<Vec3> p = surface.point(ray);
  if (!p || !is_finite(*p)) return std::nullopt;
  const int before = surface.side(ray, -ray.d);
  int side = surface.side(ray, direction);
  if (side == 0) side = before;
  if (side == 0) side = 1;  // the incoming ray lies in the surface
  DVec3 outwards = double(side) * surface.gradient(*p);
  if (outwards == DVec3(0)) outwards = direction;  // the apex of a cone
  return OriginSearch{.p = *p,
                      .side = side,
                      .goes_back = before == 0 || side == before,
                      .step = best_step(*p, outwards)};
}

}  // namespace microtrace
