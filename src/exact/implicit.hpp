#pragma once
/// The function whose zeros are a surface, in exact arithmetic.

#include "exact/numbers/root.hpp"
#include "exact/numbers/vector.hpp"

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

namespace microtrace::exact {

/// F(x) = Q(x) + linear . x + constant with a quadratic form Q: a quadric's polynomial as it
/// stands, |x - center|^2 - radius^2, or normal . (x - point) with a triangle's normal (b - a) x (c
/// - a). All numbers of the shape must be finite.
class Implicit {
 public:
  explicit Implicit(const Triangle& triangle);
  explicit Implicit(const Plane& plane);
  explicit Implicit(const Disc& disc);
  explicit Implicit(const Sphere& sphere);
  explicit Implicit(const Quadric& quadric);

  /// The part of F of degree one: of a flat surface, its normal.
  [[nodiscard]] const Vector& linear() const { return linear_; }
  /// F(p).
  [[nodiscard]] Dyadic value(const Vector& p) const;
  /// The derivative of F at p along e.
  [[nodiscard]] Dyadic slope(const Vector& p, const Vector& e) const;
  /// Q(e).
  [[nodiscard]] Dyadic quadratic(const Vector& e) const;

  /// The sign of F(o + t d).
  [[nodiscard]] int sign_at(const Ray& ray, const Root& t) const;

  /// The sign of F(o + t d + s e) for all small s > 0, where F(o + t d) = 0; 0 if it stays zero.
  [[nodiscard]] int sign_behind(const Ray& ray, const Root& t, const Vec3& e) const;

  /// How often F(p + s e) is zero for s >= 0, where F(p) is not: 0 to 2, a double zero being one.
  [[nodiscard]] int zeros_ahead(const Vec3& p, const Vec3& e) const;

 private:
  Implicit(const Vector& normal, const Vec3& point);
  /// The symmetric bilinear form with bilinear(e, e) = 2 Q(e).
  [[nodiscard]] Dyadic bilinear(const Vector& p, const Vector& e) const;

  Vector squares_;  // of x^2, y^2, z^2
  Vector mixed_;    // of yz, xz, xy
  Vector linear_;
  Dyadic constant_;
};

/// Whether a triangle with an area has a point on the segment from q to o + t d, of whose ends not
/// both are strictly on one side of its plane.
[[nodiscard]] bool meets_segment(const Triangle& triangle, const Vec3& q, const Ray& ray,
                                 const Root& t);

/// o + t d with each coordinate rounded to the nearest float32, ties to even.
[[nodiscard]] Vec3 round_point(const Ray& ray, const Root& t);

}  // namespace microtrace::exact
