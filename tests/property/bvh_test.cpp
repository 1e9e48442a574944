// Checks that Bvh returns the hit with the least (t, PrimitiveId) of all primitives. Exact
// arithmetic determines the hit of each primitive.

#include "exact/first_hit.hpp"
#include "support/cases/adversarial_rays.hpp"

#include <microtrace/bvh.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using adversarial::Random;

std::optional<Hit> by_definition(const Scene& scene, const Ray& ray) {
  std::optional<Hit> best;
  std::optional<exact::Root> best_t;
  Primitives(scene).for_each([&](PrimitiveId id, const auto& shape) {
    const auto t = exact::first_hit(shape, ray);
    if (t && (!best_t || *t < *best_t)) {
      best_t = t;
      best = Hit{.id = id, .t = exact::round_to_float(*t)};
    }
  });
  return best;
}

void add(Scene& scene, Shape shape) {
  scene.objects.push_back({.name = "", .shape = shape});
}

// Returns a point with small integer coordinates. These cause coincidences: shared edges, equal t,
// tangents, and rays within planes.
Vec3 grid_point(Random& random) {
  return random.on_grid(3);
}

Scene coincident_scene(Random& random) {
  Scene scene;
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.push_back(grid_point(random));
  for (int i = 0; i < 10; ++i) {
    const auto corner = [&] { return static_cast<std::uint32_t>(random.between(0, 7)); };
    mesh.triangles.push_back({corner(), corner(), corner()});
  }
  for (int i = 0; i < 3; ++i) {
    add(scene, Plane{grid_point(random), grid_point(random)});
    add(scene, Disc{grid_point(random), grid_point(random), float(random.between(0, 3))});
    const Sphere sphere{grid_point(random), float(random.between(0, 3))};
    add(scene, sphere);
    const Vec3 c = sphere.center;
    add(scene, Quadric{.a = 1,
                       .b = 1,
                       .c = 1,
                       .g = -2 * c.x,
                       .h = -2 * c.y,
                       .i = -2 * c.z,
                       .j = c.x * c.x + c.y * c.y + c.z * c.z - sphere.radius * sphere.radius});
  }
  add(scene, mesh);
  add(scene, mesh);  // the copy makes every hit a tie
  add(scene, Triangle{Vec3(NAN, 0, 0), Vec3(1), Vec3(2)});
  add(scene, Sphere{Vec3(0), -1});
  add(scene, Sphere{Vec3(0x1p70F, 0, 0), 0x1p70F});
  std::shuffle(scene.objects.begin(), scene.objects.end(), std::minstd_rand(random.bits()));
  return scene;
}

Ray coincident_ray(Random& random) {
  Ray ray{.o = grid_point(random), .d = grid_point(random)};
  if (random.one_in(3)) ray.t_min = 0;
  if (random.one_in(4)) ray.t_max = float(random.between(0, 8)) / 2;
  if (random.one_in(50)) ray.d.x = NAN;
  if (random.one_in(50)) ray.o.y = 0x1p80F;
  return ray;
}

bool equal(const std::optional<Hit>& a, const std::optional<Hit>& b) {
  return a.has_value() == b.has_value() && (!a || (a->id == b->id && a->t == b->t));
}

TEST(Bvh, EqualsTheDefinitionForCoincidentShapes) {
  Random random(7);
  int hits = 0;
  for (int round = 0; round < 200; ++round) {
    const Scene scene = coincident_scene(random);
    const Bvh bvh(scene);
    for (int i = 0; i < 50; ++i) {
      const Ray ray = coincident_ray(random);
      const auto expected = by_definition(scene, ray), actual = bvh.intersect(ray);
      ASSERT_TRUE(equal(actual, expected)) << "round " << round << ", ray " << i;
      hits += expected.has_value() ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 2000);
}

TEST(Bvh, BatchesEqualSingleRays) {
  Random random(8);
  for (int round = 0; round < 20; ++round) {
    const Scene scene = coincident_scene(random);
    const Bvh bvh(scene);
    std::vector<Ray> rays;
    for (int i = 0; i < 300; ++i) {
      rays.push_back(coincident_ray(random));
      if (i > 0 && !random.one_in(20)) rays.back().o = rays[rays.size() - 2].o;
      // Packets of rays with a common origin can't contain these.
      if (round % 2 == 0 && random.one_in(30)) rays.back().d *= 0x1p60F;
      if (round % 2 == 0 && random.one_in(30)) rays.back().d.x = NAN;
    }
    std::vector<std::optional<Hit>> hits(rays.size(), Hit{});
    bvh.intersect(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i)
      ASSERT_TRUE(equal(hits[i], bvh.intersect(rays[i]))) << i;
  }
}

// This tree has no triangle blocks.
TEST(Bvh, PacketsHitATreeOfSpheres) {
  Scene scene;
  for (int i = 0; i < 100; ++i) add(scene, Sphere{Vec3(i % 10, i / 10, -5), 0.5F});
  const Bvh bvh(scene);
  std::vector<Ray> rays;
  for (int i = 0; i < 64; ++i)
    rays.push_back({.o = Vec3(4, 4, 5), .d = {i % 8 - 4, i / 8 - 4, -10}});
  std::vector<std::optional<Hit>> hits(rays.size());
  bvh.intersect(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i)
    ASSERT_TRUE(equal(hits[i], by_definition(scene, rays[i]))) << i;
}

TEST(Bvh, EmptySceneAndEmptyMeshHitNothing) {
  Scene scene;
  EXPECT_FALSE(Bvh(scene).intersect(Ray{}).has_value());
  add(scene, Mesh{});
  add(scene, Sphere{Vec3(0, 0, -5), 1});
  const Bvh bvh(scene);
  EXPECT_EQ(bvh.intersect(Ray{})->id, 0U);
  EXPECT_EQ(bvh.intersect(Ray{})->t, 4);
  EXPECT_EQ(bvh.primitives().object_index(0), 1U);
}

}  // namespace
}  // namespace microtrace
