#include "exact/implicit.hpp"

#include "exact/flat.hpp"
#include "exact/numbers/round_to_double.hpp"
#include "exact/queries.hpp"
#include "exact/range.hpp"

namespace microtrace::exact {
namespace {

/// Returns m + t l.
Root linear_in(const Root& t, const Dyadic& m, const Dyadic& l) {
  return {m * t.r + l * t.p, square(l) * t.q, t.r, t.sign * l.sign()};
}

int sign(const Root& x) {
  const auto order = x <=> rational(0.0F);
  return order < 0 ? -1 : order > 0 ? 1 : 0;
}

}  // namespace

Implicit::Implicit(const Vector& normal, const Vec3& point)
    : linear_(normal), constant_(-dot(normal, vector(point))) {
  ++queries.dyadic;
}

Implicit::Implicit(const Triangle& triangle)
    : Implicit(
          normal_of(CornersOf<Dyadic>{vector(triangle.a), vector(triangle.b), vector(triangle.c)}),
          triangle.a) {}

Implicit::Implicit(const Plane& plane) : Implicit(vector(plane.normal), plane.point) {}

Implicit::Implicit(const Disc& disc) : Implicit(vector(disc.normal), disc.center) {}

Implicit::Implicit(const Sphere& sphere) : squares_{1.0F, 1.0F, 1.0F} {
  ++queries.dyadic;
  const Vector c = vector(sphere.center);
  linear_ = Dyadic(-2.0F) * c;
  constant_ = dot(c, c) - square(sphere.radius);
}

Implicit::Implicit(const Quadric& q)
    : squares_{q.a, q.b, q.c}, mixed_{q.f, q.e, q.d}, linear_{q.g, q.h, q.i}, constant_(q.j) {
  ++queries.dyadic;
}

Dyadic Implicit::value(const Vector& p) const {
  return quadratic(p) + dot(linear_, p) + constant_;
}

Dyadic Implicit::slope(const Vector& p, const Vector& e) const {
  return bilinear(p, e) + dot(linear_, e);
}

Dyadic Implicit::quadratic(const Vector& e) const {
  return dot(squares_, Vector{square(e.x), square(e.y), square(e.z)}) +
         dot(mixed_, Vector{e.y * e.z, e.x * e.z, e.x * e.y});
}

Dyadic Implicit::bilinear(const Vector& p, const Vector& e) const {
  return twice(dot(squares_, Vector{p.x * e.x, p.y * e.y, p.z * e.z})) +
         dot(mixed_, Vector{p.y * e.z + p.z * e.y, p.x * e.z + p.z * e.x, p.x * e.y + p.y * e.x});
}

int Implicit::sign_at(const Ray& ray, const Root& t) const {
  const Vector o = vector(ray.o), d = vector(ray.d);
  const Dyadic alpha = quadratic(d), beta = slope(o, d), gamma = value(o);
  // With t = (p + s sqrt(q)) / r, (alpha t^2 + beta t + gamma) r^2 is rational_part + s factor
  // sqrt(q).
  const Dyadic rational_part = alpha * (square(t.p) + (t.sign == 0 ? Dyadic() : t.q)) +
                               beta * t.p * t.r + gamma * square(t.r);
  if (t.sign == 0) return rational_part.sign();
  const Dyadic factor = twice(alpha) * t.p + beta * t.r;
  return sign({rational_part, square(factor) * t.q, 1.0F, t.sign * factor.sign()});
}

int Implicit::sign_behind(const Ray& ray, const Root& t, const Vec3& e) const {
  const Vector direction = vector(e);
  // The slope at o + t d is linear in t. If the slope vanishes, F(o + t d + s e) = s^2 Q(e).
  const int first =
      sign(linear_in(t, slope(vector(ray.o), direction), bilinear(vector(ray.d), direction)));
  return first != 0 ? first : quadratic(direction).sign();
}

DVec3 Implicit::gradient(const Ray& ray, const Root& t) const {
  const Vector o = vector(ray.o), d = vector(ray.d);
  DVec3 result{0};
  for (int k = 0; k < 3; ++k) {
    Vec3 axis{0};
    axis[k] = 1;
    const Vector e = vector(axis);
    result[k] = round_to_double(linear_in(t, slope(o, e), bilinear(d, e)));
  }
  return result;
}

int Implicit::zeros_ahead(const Vec3& p, const Vec3& e) const {
  const Vector origin = vector(p), direction = vector(e);
  // F(p + s e) = alpha s^2 + beta s + gamma.
  const Dyadic alpha = quadratic(direction), beta = slope(origin, direction), gamma = value(origin);
  const int side = gamma.sign();
  if (alpha.sign() * side < 0) return 1;  // one zero ahead, one behind
  if (beta.sign() * side >= 0) return 0;  // |F| does not decrease ahead
  if (alpha.sign() == 0) return 1;
  const auto roots = quadratic_roots(twice(alpha), beta, twice(gamma));
  if (!roots) return 0;
  return roots->lo == roots->hi ? 1 : 2;
}

bool meets_segment(const Triangle& triangle, const Vec3& q, const Ray& ray, const Root& t) {
  ++queries.dyadic;
  const Vector from = vector(q);
  const CornersOf<Dyadic> corners{vector(triangle.a) - from, vector(triangle.b) - from,
                                  vector(triangle.c) - from};
  return meets_segment_to(
      corners, vector(ray.o) - from, vector(ray.d),
      [&](const Dyadic& x, const Dyadic& y) { return sign(linear_in(t, x, y)); });
}

Vec3 round_point(const Ray& ray, const Root& t) {
  Vec3 p{0};
  for (int k = 0; k < 3; ++k) p[k] = round_to_float(linear_in(t, ray.o[k], ray.d[k]));
  return p;
}

DVec3 round_point_to_double(const Ray& ray, const Root& t) {
  DVec3 p{0};
  for (int k = 0; k < 3; ++k) p[k] = round_to_double(linear_in(t, ray.o[k], ray.d[k]));
  return p;
}

}  // namespace microtrace::exact
