#include "oracle/real_roots.hpp"

#include <cmath>
#include <vector>

#include <CGAL/Root_of_traits.h>
#include <CGAL/Simple_cartesian.h>

namespace microtrace::oracle {
namespace {

using Field = CGAL::Simple_cartesian<Rational>;
using Point = Field::Point_3;
using Vector = Field::Vector_3;

Point origin(const Ray& ray) {
  return point<Field>(ray.o);
}

Point at(const Ray& ray, const Rational& t) {
  return origin(ray) + t * vector<Field>(ray.d);
}

Rational number(float x) {
  return Rational(double{x});
}

bool is_zero(const Vec3& v) {
  return v.x == 0 && v.y == 0 && v.z == 0;
}

/// The parameters at which a polynomial of degree two or less is zero.
struct Zeros {
  bool everywhere;
  std::vector<Real> roots;  ///< in ascending order
};

/// Returns the zeros of f(o + t d). Three values determine this polynomial.
template <class Function>
Zeros zeros(const Ray& ray, Function f) {
  const Rational before = f(at(ray, -1)), c = f(at(ray, 0)), after = f(at(ray, 1));
  const Rational a = (before + after) / 2 - c;
  const Rational b = (after - before) / 2;
  if (a != 0) {
    const Rational discriminant = b * b - 4 * a * c;
    if (discriminant < 0) return {false, {}};
    if (discriminant == 0) return {false, {Real(-b / (2 * a))}};
    return {false, {CGAL::make_root_of_2(a, b, c, true), CGAL::make_root_of_2(a, b, c, false)}};
  }
  if (b != 0) return {false, {Real(-c / b)}};
  return {c == 0, {}};
}

bool is_in_range(const Real& t, const Ray& ray) {
  return number(ray.t_min) <= t && (std::isinf(ray.t_max) || t <= number(ray.t_max));
}

std::optional<Real> first(const Zeros& zeros, const Ray& ray) {
  if (is_zero(ray.d)) return std::nullopt;
  if (zeros.everywhere) return Real(number(ray.t_min));
  for (const Real& t : zeros.roots) {
    if (is_in_range(t, ray)) return t;
  }
  return std::nullopt;
}

auto plane_function(const Vec3& p, const Vec3& n) {
  return [=](const Point& x) -> Rational { return vector<Field>(n) * (x - point<Field>(p)); };
}

auto sphere_function(const Vec3& center, float radius) {
  return [=](const Point& x) -> Rational {
    const Vector m = x - point<Field>(center);
    return m * m - number(radius) * number(radius);
  };
}

}  // namespace

std::optional<Real> first_parameter(const Plane& plane, const Ray& ray) {
  if (is_zero(plane.normal)) return std::nullopt;
  return first(zeros(ray, plane_function(plane.point, plane.normal)), ray);
}

std::optional<Real> first_parameter(const Disc& disc, const Ray& ray) {
  if (is_zero(disc.normal) || is_zero(ray.d)) return std::nullopt;
  const auto ball = sphere_function(disc.center, disc.radius);
  const Zeros in_plane = zeros(ray, plane_function(disc.center, disc.normal));
  if (!in_plane.everywhere) {
    const auto t = first(in_plane, ray);
    return t && ball(at(ray, t->a0())) <= 0 ? t : std::nullopt;
  }
  const Zeros rim = zeros(ray, ball);
  const Real t_min(number(ray.t_min));
  if (rim.roots.empty() || rim.roots.back() < t_min) return std::nullopt;
  const Real entry = rim.roots.front() < t_min ? t_min : rim.roots.front();
  return is_in_range(entry, ray) ? std::optional(entry) : std::nullopt;
}

std::optional<Real> first_parameter(const Sphere& sphere, const Ray& ray) {
  return first(zeros(ray, sphere_function(sphere.center, sphere.radius)), ray);
}

std::optional<Real> first_parameter(const Quadric& q, const Ray& ray) {
  const auto function = [&](const Point& p) -> Rational {
    return number(q.a) * p.x() * p.x() + number(q.b) * p.y() * p.y() + number(q.c) * p.z() * p.z() +
           number(q.d) * p.x() * p.y() + number(q.e) * p.x() * p.z() + number(q.f) * p.y() * p.z() +
           number(q.g) * p.x() + number(q.h) * p.y() + number(q.i) * p.z() + number(q.j);
  };
  return first(zeros(ray, function), ray);
}

Real to_real(const exact::Root& t) {
  const Rational r = to_rational(t.r);
  const Rational rational_part = to_rational(t.p) / r;
  // CGAL requires a positive number under the square root.
  if (t.sign == 0 || t.q.sign() == 0) return Real(rational_part);
  return Real(rational_part, t.sign / r, to_rational(t.q));
}

}  // namespace microtrace::oracle
