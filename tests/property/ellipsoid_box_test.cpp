// Tests the boxes of ellipsoids with exact arithmetic.

#include "support/ellipsoid_box.hpp"

#include "accel/build/references/shape_box.hpp"
#include "support/cases/adversarial_rays.hpp"

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

using adversarial::Random;

/// Returns the ellipsoid (p - center)^T m (p - center) = right, with rounded coefficients.
Quadric ellipsoid(const glm::dmat3& m, const DVec3& center, double right) {
  const DVec3 linear = -2.0 * (m * center);
  const auto f = [](double v) { return static_cast<float>(v); };
  return {.a = f(m[0][0]),
          .b = f(m[1][1]),
          .c = f(m[2][2]),
          .d = f(2 * m[0][1]),
          .e = f(2 * m[0][2]),
          .f = f(2 * m[1][2]),
          .g = f(linear.x),
          .h = f(linear.y),
          .i = f(linear.z),
          .j = f(glm::dot(center, m * center) - right)};
}

/// Returns an ellipsoid with axes of any direction.
Quadric rotated(Random& random, const DVec3& center, const DVec3& radii) {
  const DVec3 x = glm::normalize(DVec3(random.in_cube(1)));
  const DVec3 y = glm::normalize(glm::cross(x, DVec3(random.in_cube(1))));
  const DVec3 z = glm::cross(x, y);
  glm::dmat3 m(0);
  for (int k = 0; k < 3; ++k) {
    const DVec3& axis = k == 0 ? x : k == 1 ? y : z;
    m += glm::outerProduct(axis, axis) / (radii[k] * radii[k]);
  }
  return ellipsoid(m, center, 1);
}

/// Returns an ellipsoid that is nearly a cylinder or a pair of planes, or another quadric. Its
/// matrix of integers is nearly singular.
Quadric flat(Random& random, const DVec3& center) {
  const int size = 1 << random.between(2, 11);
  const auto number = [&] { return static_cast<double>(random.between(-size, size)); };
  const DVec3 u(number(), number(), number()), v(number(), number(), number());
  glm::dmat3 m = glm::outerProduct(u, u) + glm::outerProduct(v, v);
  for (int k = 0; k < 3; ++k) m[k][k] += random.between(-2, 3);
  return ellipsoid(m, center, random.between(0, size));
}

Bounds bounds(const build::Box& box) {
  return {.lo = {box.lo[0], box.lo[1], box.lo[2]}, .hi = {box.hi[0], box.hi[1], box.hi[2]}};
}

/// The box without a margin that is greater than the rounding of its ends.
Bounds shrunk(const Bounds& b) {
  const Vec3 off = 0x1p-16F * (b.hi - b.lo) + 0x1p-20F * glm::abs(b.lo);
  return {.lo = b.lo + off, .hi = b.hi - off};
}

TEST(EllipsoidBox, HoldsTheEllipsoid) {
  constexpr int kCases = 40000;
  Random random(1);
  int bounded = 0, tight = 0;
  for (int i = 0; i < kCases; ++i) {
    const int most = random.between(0, 14);  // elongated ones are ill-conditioned
    const auto radius = [&] { return std::exp2(2 * random.unit() * most - most); };
    const DVec3 center = DVec3(random.in_cube(random.power_of_two(-4, 6)));
    Quadric q = rotated(random, center, {radius(), radius(), radius()});
    if (random.one_in(8)) {  // nearly or exactly a point
      const Vec3 c = random.on_grid(9);
      q = {.a = 1, .b = 1, .c = 1, .g = -2 * c.x, .h = -2 * c.y, .i = -2 * c.z};
      q.j = adversarial::moved(glm::dot(c, c), random.between(-2, 2));
    }
    if (random.one_in(2)) q = flat(random, center);
    const build::Box box = build::box_of(q);
    if (!build::is_finite(box)) continue;
    ++bounded;
    EXPECT_TRUE(holds_ellipsoid(bounds(box), q)) << "case " << i;
    tight += holds_ellipsoid(shrunk(bounds(box)), q) ? 0 : 1;
  }
  EXPECT_GT(bounded, kCases / 3);
  EXPECT_GT(tight, bounded * 3 / 4);
}

}  // namespace
}  // namespace microtrace
