// Checks that no segment next to a clear point meets a surface, and that clear points don't depend
// on the tree.

#include "accel/spawn/box_clearance.hpp"
#include "exact/triangle_box.hpp"
#include "support/cases/adversarial_scenes.hpp"
#include "support/cases/closed_meshes.hpp"

#include <microtrace/bvh.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;

/// Adds shapes of all kinds.
void add_shapes(Random& random, Scene& scene) {
  const auto add = [&](const Shape& shape) {
    scene.objects.push_back({.name = "", .shape = shape});
  };
  for (int i = 0; i < 3; ++i) {
    add(Sphere{.center = random.in_cube(2), .radius = random.power_of_two(-6, 1)});
    add(Disc{.center = random.in_cube(2), .normal = random.in_cube(1), .radius = 1});
  }
  add(Plane{.point = random.in_cube(2), .normal = random.on_grid(1) + Vec3(0, 0, 3)});
  add(Quadric{.a = 1, .b = 2, .c = -1, .j = random.symmetric()});
}

/// A point whose coordinates are each p's or a neighboring float32.
Vec3 neighbor_of(Random& random, const Vec3& p) {
  Vec3 result = p;
  for (int k = 0; k < 3; ++k) {
    const int step = random.between(-1, 1);
    const float up = std::numeric_limits<float>::infinity();
    if (step != 0) result[k] = std::nextafter(p[k], step > 0 ? up : -up);
  }
  return result;
}

TEST(ClearPoint, SegmentsMeetNoSurface) {
  Random random(71);
  int clear = 0, met = 0;
  for (int i = 0; i < 300 && !testing::Test::HasFatalFailure(); ++i) {
    Scene scene = random_scene(random);
    if (random.one_in(2)) add_shapes(random, scene);
    const Bvh bvh(scene), other(scene, {.fast_build = true});
    for (int k = 0; k < 200; ++k) {
      // Most points are within a few steps of a surface.
      const Ray ray = random_ray(random, scene, origin(random, scene));
      const auto hit = bvh.intersect(ray);
      if (!hit) continue;
      const Vec3 p = random.jitter(Vec3(DVec3(ray.o) + double{hit->t} * DVec3(ray.d)), 3);
      const bool is_clear = bvh.is_clear(p);
      ASSERT_EQ(other.is_clear(p), is_clear);
      clear += is_clear ? 1 : 0;
      const Vec3 from = neighbor_of(random, p), to = neighbor_of(random, p), d = to - from;
      // The difference of neighbors is usually exact.
      if (d == Vec3(0) || DVec3(from) + DVec3(d) != DVec3(to)) continue;
      const bool is_met = bvh.occluded({.o = from, .t_min = 0, .d = d, .t_max = 1});
      met += is_met ? 1 : 0;
      ASSERT_FALSE(is_clear && is_met) << i << ' ' << k;
    }
  }
  EXPECT_GT(clear, 5000);
  EXPECT_GT(met, 200);
}

// Float64 finds only some of the axes that separate a box and a triangle. Whether it has to depends
// on the tree, which may have split the triangle, so the result must be exact.
TEST(ClearPoint, IsExactBesideTriangles) {
  Random random(73);
  int met = 0, open = 0;
  for (int i = 0; i < 20000; ++i) {
    const Triangle t{.a = random.in_cube(1), .b = random.in_cube(1), .c = random.in_cube(1)};
    const double s = random.unit();
    const Vec3 p = random.jitter(Vec3(DVec3(t.a) * (1 - s) + DVec3(t.b) * s), 2);
    const DVec3 radius(spacing(p.x), spacing(p.y), spacing(p.z));
    const bool is_met = exact::meets_box(t, Vec3(DVec3(p) - radius), Vec3(DVec3(p) + radius));
    Scene scene;
    scene.objects.push_back({.name = "", .shape = t});
    ASSERT_EQ(Bvh(scene).is_clear(p), !is_met) << i;
    met += is_met ? 1 : 0;
    open += !is_met && !clears_box(t, DVec3(p), radius) ? 1 : 0;
  }
  EXPECT_GT(met, 1000);
  EXPECT_GT(open, 20);
}

// Points in the middle of bodies, and next to their surfaces at distances of a hundred steps.
TEST(ClearPoint, OnlyPointsNextToSurfacesAreNotClear) {
  Scene scene;
  scene.objects.push_back({.name = "", .shape = Sphere{{0, 0, 0}, 1}});
  const ClosedMesh closed = closed_meshes()[0];
  scene.objects.push_back({.name = "", .shape = closed.mesh});
  const Bvh bvh(scene);
  Random random(72);
  int clear = 0;
  for (int i = 0; i < 1000; ++i) clear += bvh.is_clear(random.in_cube(1)) ? 1 : 0;
  EXPECT_GT(clear, 990);
  EXPECT_FALSE(bvh.is_clear({1, 0, 0}));
  EXPECT_FALSE(bvh.is_clear({std::nextafter(1.0F, 0.0F), 0, 0}));
  EXPECT_TRUE(bvh.is_clear({1 - 0x1p-17F, 0.25F, 0.25F}));
  const Vec3 corner = closed.mesh.positions[0];
  EXPECT_FALSE(bvh.is_clear(corner));
  EXPECT_FALSE(bvh.is_clear(Vec3(std::numeric_limits<float>::quiet_NaN())));
}

}  // namespace
}  // namespace microtrace
