#pragma once
/// The implicit function of a surface, evaluated exactly.

#include "exact/numbers/root.hpp"
#include "exact/numbers/vector.hpp"

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

namespace microtrace::exact {

/// The function F(x) = Q(x) + linear . x + constant, where Q is a quadratic form. F is the
/// polynomial of a quadric, |x - center|^2 - radius^2 for a sphere, and normal . (x - point) for
/// flat shapes. The normal of a triangle is (b - a) x (c - a). All numbers of the shape must be
/// finite.
class Implicit {
 public:
  explicit Implicit(const Triangle& triangle);
  explicit Implicit(const Plane& plane);
  explicit Implicit(const Disc& disc);
  explicit Implicit(const Sphere& sphere);
  explicit Implicit(const Quadric& quadric);

  /// Returns the coefficients of degree one, which are the normal of a flat shape.
  [[nodiscard]] const Vector& linear() const { return linear_; }
  /// Returns F(p).
  [[nodiscard]] Dyadic value(const Vector& p) const;
  /// Returns the derivative of F at p along e.
  [[nodiscard]] Dyadic slope(const Vector& p, const Vector& e) const;
  /// Returns Q(e).
  [[nodiscard]] Dyadic quadratic(const Vector& e) const;

  /// Returns the sign of F(o + t d).
  [[nodiscard]] int sign_at(const Ray& ray, const Root& t) const;

  /// Returns the sign of F(o + t d + s e) for all sufficiently small s > 0, given F(o + t d) = 0.
  /// The sign is 0 if F stays zero along e.
  [[nodiscard]] int sign_behind(const Ray& ray, const Root& t, const Vec3& e) const;

  /// Returns the gradient of F at o + t d, with each component rounded to the nearest float64.
  [[nodiscard]] DVec3 gradient(const Ray& ray, const Root& t) const;

  /// Returns the number of zeros of F(p + s e) with s >= 0, given F(p) != 0. The number is 0, 1 or
  /// 2; a double zero counts once.
  [[nodiscard]] int zeros_ahead(const Vec3& p, const Vec3& e) const;

 private:
  Implicit(const Vector& normal, const Vec3& point);
  /// The symmetric bilinear form with bilinear(e, e) = 2 Q(e).
  [[nodiscard]] Dyadic bilinear(const Vector& p, const Vector& e) const;

  Vector squares_;  // coefficients of x^2, y^2, z^2
  Vector mixed_;    // coefficients of yz, xz, xy
  Vector linear_;
  Dyadic constant_;
};

/// Returns true if a triangle of nonzero area has a common point with the segment from q to o + t
/// d. The ends of the segment must not both be strictly on the same side of the triangle's plane.
[[nodiscard]] bool meets_segment(const Triangle& triangle, const Vec3& q, const Ray& ray,
                                 const Root& t);

/// Returns o + t d with each coordinate rounded to the nearest float32, ties to even.
[[nodiscard]] Vec3 round_point(const Ray& ray, const Root& t);
/// The same with float64.
[[nodiscard]] DVec3 round_point_to_double(const Ray& ray, const Root& t);

}  // namespace microtrace::exact
