// Tests boxes that are certainly clear of a surface: no segment between two points of such a box
// may meet the surface.

#include "accel/spawn/box_clearance.hpp"

#include "exact/first_hit.hpp"
#include "support/cases/adversarial_rays.hpp"
#include "support/reproduction.hpp"

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using adversarial::Random;

// Returns a triangle with vertices on a grid. Many have no area, or a vertex that lies nearly on an
// edge's line.
Triangle triangle_on_grid(Random& random) {
  Triangle t{random.on_grid(4), random.on_grid(4), random.on_grid(4)};
  switch (random.between(0, 4)) {
    case 0:
      t.c = t.a;
      break;
    case 1:
      t.c = (t.a + t.b) * 0.5F;
      break;
    case 2:
      t.c = t.a + (t.b - t.a) * 2.0F + random.on_grid(1, 0x1p-20F);
      break;
    default:
      break;
  }
  if (random.one_in(2)) std::swap(t.a, t.c);
  if (random.one_in(2)) std::swap(t.b, t.c);
  return t;
}

TEST(BoxClearance, CertainClearanceOfTriangles) {
  Random random(41);
  int passed = 0, met = 0;
  for (int i = 0; i < 200000 && !testing::Test::HasFatalFailure(); ++i) {
    const Triangle t = triangle_on_grid(random);
    const float radius = random.power_of_two(-12, 0);
    // A point on an edge, or at a distance of about the box's size from it.
    const float share = 0.125F * static_cast<float>(random.between(0, 8));
    const Vec3 p = t.a + (t.b - t.a) * share + random.on_grid(3, 0.75F * radius);
    const bool passes_it = clears_box(t, DVec3(p), DVec3(radius));
    passed += passes_it ? 1 : 0;
    for (int k = 0; k < 6; ++k) {
      const Vec3 from = p + random.on_grid(2, radius / 2), to = p + random.on_grid(2, radius / 2);
      if (from == to) continue;
      const Ray way{.o = from, .t_min = 0, .d = to - from, .t_max = 1};
      const bool is_met = exact::first_hit(t, way).has_value();
      met += is_met ? 1 : 0;
      ASSERT_FALSE(passes_it && is_met) << adversarial::reproduction(way, t);
    }
  }
  EXPECT_GT(passed, 10000);
  EXPECT_GT(met, 10000);
}

// Tests projections along each of the axes.
TEST(BoxClearance, CertainClearanceOfSegments) {
  Random random(42);
  for (int i = 0; i < 10000; ++i) {
    const Vec3 a = random.on_grid(1024, 0x1p-10F), half = random.on_grid(1024, 0x1p-10F);
    const Vec3 b = a + 2.0F * half, c = i % 2 == 0 ? a : a + half;
    const int axis = random.between(0, 2);
    Vec3 across(0);
    // A vector perpendicular to the segment and to the axis.
    across[(axis + 1) % 3] = half[(axis + 2) % 3];
    across[(axis + 2) % 3] = -half[(axis + 1) % 3];
    if (across == Vec3(0)) continue;
    const Vec3 p = a + half * 0.5F + across * 0.25F;
    EXPECT_TRUE(clears_box(Triangle{a, b, c}, DVec3(p), DVec3(0x1p-14))) << i;
  }
}

}  // namespace
}  // namespace microtrace
