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
Box extended(const Vec3& center, const DVec3& reach) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    const double c = center[k], slack = 0x1p-48 * (std::abs(c) + reach[k]);
    box.lo[k] = float_below(c - reach[k] - slack);
    box.hi[k] = -float_below(-(c + reach[k] + slack));
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
  return extended(s.center, DVec3(s.radius));
}

// Along axis k a disc extends r sqrt(1 - n_k^2 / n.n) from its center.
Box box_of(const Disc& d) {
  const DVec3 n2 = DVec3(d.normal) * DVec3(d.normal);
  const double sum = n2.x + n2.y + n2.z;
  const DVec3 others(n2.y + n2.z, n2.z + n2.x, n2.x + n2.y);
  return extended(d.center, double{d.radius} * glm::sqrt(others / sum));
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
