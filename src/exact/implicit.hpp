#pragma once
/// The implicit function of a surface, in exact arithmetic.

#include "exact/numbers/root.hpp"
#include "exact/numbers/vector.hpp"

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

namespace microtrace::exact {

/// F(x) = Q(x) + linear . x + constant with a quadratic form Q. For a quadric F is its polynomial,
/// for a sphere |x - center|^2 - radius^2, for flat shapes normal . (x - point), where a triangle
/// has the normal (b - a) x (c - a). All numbers of the shape must be finite.
class Implicit {
 public:
  explicit Implicit(const Triangle& triangle);
  explicit Implicit(const Plane& plane);
  explicit Implicit(const Disc& disc);
  explicit Implicit(const Sphere& sphere);
  explicit Implicit(const Quadric& quadric);

  /// The coefficients of degree one; for a flat surface its normal.
  [[nodiscard]] const Vector& linear() const { return linear_; }
  /// F(p).
  [[nodiscard]] Dyadic value(const Vector& p) const;
  /// The derivative of F at p along e.
  [[nodiscard]] Dyadic slope(const Vector& p, const Vector& e) const;
  /// Q(e).
  [[nodiscard]] Dyadic quadratic(const Vector& e) const;

  /// The sign of F(o + t d).
  [[nodiscard]] int sign_at(const Ray& ray, const Root& t) const;

  /// The sign of F(o + t d + s e) for all small s > 0, where F(o + t d) = 0. Returns 0 if it stays
  /// zero.
  [[nodiscard]] int sign_behind(const Ray& ray, const Root& t, const Vec3& e) const;

  /// The number of zeros of F(p + s e) for s >= 0, given F(p) != 0: 0 to 2, a double zero counts
  /// once.
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

/// True if a triangle with an area has a point on the segment from q to o + t d, given that the
/// segment's ends are not both strictly on one side of its plane.
[[nodiscard]] bool meets_segment(const Triangle& triangle, const Vec3& q, const Ray& ray,
                                 const Root& t);

/// o + t d with each coordinate rounded to the nearest float32, ties to even.
[[nodiscard]] Vec3 round_point(const Ray& ray, const Root& t);

}  // namespace microtrace::exact
