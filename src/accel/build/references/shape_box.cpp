#include "accel/build/references/shape_box.hpp"

#include "base/finite.hpp"

#include <cmath>

#include <glm/common.hpp>

namespace microtrace::build {
namespace {

template <class... Numbers>
bool all_finite(Numbers... x) {
  return (std::isfinite(x) && ...);
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Returns the largest float32 strictly below x.
float float_below(double x) {
  if (x < -double{std::numeric_limits<float>::max()}) return -kInfinity;
  if (x > double{std::numeric_limits<float>::max()}) return std::numeric_limits<float>::max();
  const auto f = static_cast<float>(x);
  return double{f} < x ? f : std::nextafter(f, -kInfinity);
}

// Returns a box that contains center +- reach, where `reach` may have an error of a few units of
// roundoff.
Box extended(const DVec3& center, const DVec3& reach) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    const double c = center[k], slack = 0x1p-48 * (std::abs(c) + reach[k]);
    box.lo[k] = float_below(c - reach[k] - slack);
    box.hi[k] = -float_below(-(c + reach[k] + slack));
  }
  return box;
}

Box whole() {
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = -kInfinity;
    box.hi[k] = kInfinity;
  }
  return box;
}

}  // namespace

bool is_empty(const Sphere& s) {
  return !(microtrace::is_finite(s.center) && std::isfinite(s.radius) && s.radius >= 0);
}
bool is_empty(const Disc& d) {
  return is_empty(Sphere{.center = d.center, .radius = d.radius}) ||
         is_empty(Plane{.point = d.center, .normal = d.normal});
}
bool is_empty(const Plane& p) {
  return !(microtrace::is_finite(p.point) && microtrace::is_finite(p.normal) &&
           p.normal != Vec3(0));
}
bool is_empty(const Quadric& q) {
  return !all_finite(q.a, q.b, q.c, q.d, q.e, q.f, q.g, q.h, q.i, q.j);
}

Box box_of(const Sphere& s) {
  return extended(DVec3(s.center), DVec3(s.radius));
}

// Along axis k a disc extends r sqrt(1 - n_k^2 / n.n) from its center.
Box box_of(const Disc& d) {
  const DVec3 n2 = DVec3(d.normal) * DVec3(d.normal);
  const double sum = n2.x + n2.y + n2.z;
  const DVec3 others(n2.y + n2.z, n2.z + n2.x, n2.x + n2.y);
  return extended(DVec3(d.center), double{d.radius} * glm::sqrt(others / sum));
}

// With the symmetric matrix M of second derivatives and the gradient g at the origin, the center is
// c = -M^-1 g. An ellipsoid extends sqrt(n adj_kk) / det along axis k from its center, where adj is
// the adjugate of M, det its determinant, and n = g^T adj g - 2 j det. Products of two coefficients
// are exact in float64, so each element of adj has one rounding. The sums below have at most 12.
Box box_of(const Quadric& q) {
  constexpr double kError = 16 * 0x1p-53;
  const double sign = q.a < 0 ? -1 : 1;  // makes M positive definite
  const DVec3 diagonal = 2 * sign * DVec3(q.a, q.b, q.c);
  const double xy = sign * q.d, xz = sign * q.e, yz = sign * q.f, j = sign * q.j;
  const DVec3 g = sign * DVec3(q.g, q.h, q.i);
  const DVec3 own(diagonal.y * diagonal.z - yz * yz, diagonal.x * diagonal.z - xz * xz,
                  diagonal.x * diagonal.y - xy * xy);
  const double of_xy = xz * yz - xy * diagonal.z, of_xz = xy * yz - xz * diagonal.y,
               of_yz = xy * xz - yz * diagonal.x;
  const auto row = [&](double x, double y, double z, const DVec3& v) {
    return x * v.x + y * v.y + z * v.z;
  };
  const auto product = [&](const auto& element, const DVec3& v) {
    return DVec3(row(element(own.x), element(of_xy), element(of_xz), v),
                 row(element(of_xy), element(own.y), element(of_yz), v),
                 row(element(of_xz), element(of_yz), element(own.z), v));
  };
  const auto same = [](double x) { return x; };
  const auto size = [](double x) { return std::abs(x); };
  const DVec3 first(diagonal.x, xy, xz);
  const double det = product(same, first).x;
  const double det_error = kError * product(size, glm::abs(first)).x;
  const double least = det - det_error;
  const DVec3 v = product(same, g), v_size = product(size, glm::abs(g));
  const double n = glm::dot(g, v) - 2 * j * det;
  const double n_error =
      kError * (glm::dot(glm::abs(g), v_size) + 2 * std::abs(j) * product(size, glm::abs(first)).x);
  const double most = n + n_error;
  constexpr double kWide = 0x1p-20;  // greatest relative error
  if (!(diagonal.x > 0 && own.z > 0 && least > 0 && det_error <= kWide * least && most >= 0))
    return whole();
  const DVec3 center = -v / det;
  const DVec3 center_error = (kError * v_size + glm::abs(center) * det_error) / least;
  return extended(center, glm::sqrt(most) * glm::sqrt(own) * (1 + 0x1p-48) / least + center_error);
}

Box around(const DVec3& point, const DVec3& size) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = float_below(point[k] - 0x1p-50 * size[k]);
    box.hi[k] = -float_below(-(point[k] + 0x1p-50 * size[k]));
  }
  return box;
}

bool is_finite(const Box& b) {
  return all_finite(b.lo[0], b.lo[1], b.lo[2], b.hi[0], b.hi[1], b.hi[2]);
}

}  // namespace microtrace::build
