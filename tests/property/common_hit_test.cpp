// Checks that all rays of a frustum have the hit that Bvh::common_hit returns.

#include "support/cases/adversarial_scenes.hpp"
#include "support/effort.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/camera.hpp>

#include <cmath>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

using adversarial::Random;

constexpr ImageSize kSize{.width = 256, .height = 192};

/// Mostly large shapes around the origin, some of which touch or coincide.
Shape random_shape(Random& random) {
  const auto point = [&] { return random.one_in(3) ? random.on_grid(4) : random.in_cube(4); };
  const float size = random.one_in(4) ? random.power_of_two(-8, 6) : random.power_of_two(-1, 2);
  switch (random.between(0, 5)) {
    case 0:
      return Plane{.point = point(), .normal = random.one_in(2) ? random.on_grid(1) : point()};
    case 1:
      return Disc{.center = point(), .normal = point(), .radius = size};
    case 2: {
      const Vec3 a = point();
      return Triangle{.a = a, .b = a + size * point(), .c = a + size * point()};
    }
    case 3:
      return Quadric{.a = 1, .b = size, .c = random.symmetric(), .j = -1};
    default:
      return Sphere{.center = point(), .radius = random.one_in(20) ? -size : size};
  }
}

Scene scene_of_shapes(Random& random) {
  Scene scene;
  for (int i = random.between(1, 6); i > 0; --i)
    scene.objects.push_back({.name = "", .shape = random_shape(random)});
  if (random.one_in(3)) scene.objects.push_back(scene.objects.front());  // a copy at the same place
  return scene;
}

PerspectiveCamera random_camera(Random& random, const Vec3& position) {
  PerspectiveCamera camera;
  camera.pose = {.position = position, .direction = -position + random.in_cube(2), .up = {0, 1, 0}};
  if (random.one_in(4)) camera.pose.direction = DVec3(0, 0, random.one_in(2) ? 1 : -1);
  camera.vertical_fov = random.one_in(4) ? 3 * random.unit() + 0.1 : 1;
  if (random.one_in(4)) camera.depth = {.near = random.unit(), .far = 2 + 8 * random.unit()};
  return camera;
}

struct Counts {
  int hits = 0, misses = 0, unknown = 0;
};

/// Compares random frustums with their rays.
void check(Random& random, const Scene& scene, const Vec3& position, Counts& counts) {
  const Bvh bvh(scene);
  const RayGenerator camera(random_camera(random, position), kSize);
  for (int tile = 0; tile < 60; ++tile) {
    const double edge = random.one_in(2) ? 16 : 64;
    const double width = random.one_in(4) ? 0 : edge * random.unit(), height = edge * random.unit();
    const double x0 = kSize.width * random.unit(), y0 = kSize.height * random.unit();
    const std::optional<Frustum> frustum = camera.frustum(x0, y0, x0 + width, y0 + height);
    if (!frustum) continue;  // too wide
    const CommonHit common = bvh.common_hit(*frustum);
    ++(!common.is_known ? counts.unknown : common.id ? counts.hits : counts.misses);
    if (!common.is_known) continue;
    for (int i = 0; i <= 4; ++i) {
      for (int k = 0; k <= 4; ++k) {
        const std::optional<Hit> hit =
            bvh.intersect(camera(x0 + width * i / 4, y0 + height * k / 4));
        ASSERT_EQ(hit ? hit->id : kNoPrimitive, common.id.value_or(kNoPrimitive))
            << "tile " << tile;
      }
    }
  }
}

TEST(CommonHit, IsTheHitOfAllRays) {
  Random random = traversal::announced_random(100);
  Counts counts;
  const std::size_t rounds = traversal::ray_count(0.001) + 1000;
  for (std::size_t round = 0; round < rounds; ++round) {
    SCOPED_TRACE(round);
    const Scene scene = scene_of_shapes(random);
    const float distance = random.one_in(4) ? random.power_of_two(-2, 8) : 10;
    check(random, scene, distance * random.in_cube(1), counts);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(counts.hits, counts.unknown / 8);
  EXPECT_GT(counts.misses, counts.unknown / 8);
}

TEST(CommonHit, HoldsInDifficultScenes) {
  Random random = traversal::announced_random(101);
  Counts counts;
  for (const adversarial::SceneKind kind : adversarial::kSceneKinds) {
    SCOPED_TRACE(name(kind));
    for (int round = 0; round < 60; ++round) {
      const Scene scene = random_scene(random, kind);
      Vec3 position = origin(random, scene);
      if (!std::isfinite(position.x + position.y + position.z)) position = Vec3(0);
      check(random, scene, position + random.in_cube(2), counts);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(counts.hits, 100);
  EXPECT_GT(counts.misses, 100);
}

// Frustums of one ray, which touches an edge or a sphere if its direction is not rounded.
TEST(CommonHit, AllowsForTheRoundingOfDirections) {
  Random random = traversal::announced_random(102);
  int unknown = 0, hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const RayGenerator camera(random_camera(random, 4.0F * random.in_cube(1)), kSize);
    const double x = kSize.width * random.unit(), y = kSize.height * random.unit();
    const std::optional<Frustum> frustum = camera.frustum(x, y, x, y);
    if (!frustum) continue;
    const DVec3 direction = glm::normalize(frustum->middle);
    const DVec3 touched = DVec3(frustum->o) + direction * (1 + 4 * random.unit());
    const DVec3 beside = glm::normalize(glm::cross(direction, DVec3(random.in_cube(1))));
    const double size = 0.1 + random.unit();
    Scene scene;
    if (random.one_in(2))
      scene.objects.push_back({.name = "",
                               .shape = Triangle{.a = Vec3(touched + size * beside),
                                                 .b = Vec3(touched - size * beside),
                                                 .c = random.in_cube(4)}});
    else
      scene.objects.push_back({.name = "",
                               .shape = Sphere{.center = Vec3(touched + size * beside),
                                               .radius = static_cast<float>(size)}});
    const Bvh bvh(scene);
    const CommonHit common = bvh.common_hit(*frustum);
    const bool is_hit = bvh.intersect(camera(x, y)).has_value();
    ASSERT_TRUE(!common.is_known || common.id.has_value() == is_hit) << i;
    unknown += common.is_known ? 0 : 1;
    hits += is_hit ? 1 : 0;
  }
  EXPECT_GT(unknown, 10000);
  EXPECT_GT(hits, 4000);
}

}  // namespace
}  // namespace microtrace
