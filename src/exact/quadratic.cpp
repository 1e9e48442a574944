#include "exact/first_hit.hpp"
#include "exact/numbers/vector.hpp"
#include "exact/queries.hpp"
#include "exact/range.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace microtrace::exact {
namespace {

/// Returns the first root of a t^2 + 2 b t + c in the ray's interval. a must not be zero.
std::optional<Root> first_root(const Dyadic& a, const Dyadic& b, const Dyadic& c, const Ray& ray) {
  const auto roots = quadratic_roots(a, b, c);
  if (!roots) return std::nullopt;
  return in_range(roots->lo, ray) ? roots->lo : first_in_range(roots->hi, ray);
}

/// Returns the sum of the quadric's terms of degree two at p: a x^2 + b y^2 + c z^2 + d xy + e xz +
/// f yz.
Dyadic quadratic_part(const Quadric& q, const Vector& p) {
  return q.a * square(p.x) + q.b * square(p.y) + q.c * square(p.z) +  //
         q.d * (p.x * p.y) + q.e * (p.x * p.z) + q.f * (p.y * p.z);
}

/// Returns the sum of the quadric's terms of degree one at p: g x + h y + i z.
Dyadic linear_part(const Quadric& q, const Vector& p) {
  return q.g * p.x + q.h * p.y + q.i * p.z;
}

/// Returns B(p, r), where B is the symmetric bilinear form with B(p, p) = 2 quadratic_part(p).
Dyadic bilinear_part(const Quadric& q, const Vector& p, const Vector& r) {
  return twice(q.a * (p.x * r.x) + q.b * (p.y * r.y) + q.c * (p.z * r.z)) +
         q.d * (p.x * r.y + p.y * r.x) + q.e * (p.x * r.z + p.z * r.x) +
         q.f * (p.y * r.z + p.z * r.y);
}

}  // namespace

bool is_empty(const Sphere& sphere) {
  return !is_finite(sphere.center) || !std::isfinite(sphere.radius) || sphere.radius < 0;
}

bool is_empty(const Quadric& q) {
  const std::array coefficients{q.a, q.b, q.c, q.d, q.e, q.f, q.g, q.h, q.i, q.j};
  return !std::ranges::all_of(coefficients, [](float x) { return std::isfinite(x); });
}

std::optional<Root> first_hit(const Sphere& sphere, const Ray& ray) {
  ++queries.dyadic;
  if (!is_valid(ray) || is_empty(sphere)) return std::nullopt;
  const Vector d = vector(ray.d);
  const Vector m = vector(ray.o) - vector(sphere.center);
  return first_root(dot(d, d), dot(d, m), dot(m, m) - square(sphere.radius), ray);
}

std::optional<Root> first_hit(const Quadric& quadric, const Ray& ray) {
  ++queries.dyadic;
  if (!is_valid(ray) || is_empty(quadric)) return std::nullopt;
  const Vector o = vector(ray.o), d = vector(ray.d);
  // F(o + t d) = alpha t^2 + beta t + gamma.
  const Dyadic alpha = quadratic_part(quadric, d);
  const Dyadic beta = bilinear_part(quadric, o, d) + linear_part(quadric, d);
  const Dyadic gamma = quadratic_part(quadric, o) + linear_part(quadric, o) + quadric.j;
  if (alpha.sign() != 0) return first_root(twice(alpha), beta, twice(gamma), ray);
  if (beta.sign() != 0) return first_in_range(rational(-gamma, beta), ray);
  if (gamma.sign() != 0) return std::nullopt;
  return rational(ray.t_min);
}

}  // namespace microtrace::exact
