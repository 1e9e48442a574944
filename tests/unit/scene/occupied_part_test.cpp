#include "scene/occupied_part.hpp"

#include "support/cases/generated_meshes.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/camera.hpp>
#include <microtrace/scene.hpp>

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr ImageSize kPartSize{.width = 90, .height = 70};
constexpr PixelRect kWindow{.x0 = 0, .y0 = 0, .x1 = kPartSize.width, .y1 = kPartSize.height};

Scene sphere(const Vec3& center, float radius) {
  Mesh mesh = generated::displaced_sphere(400);
  std::vector<Vec3> positions;
  for (const Vec3& p : mesh.positions) positions.push_back(center + p * radius);
  mesh.positions = positions;
  Scene scene;
  scene.objects.push_back({.name = "sphere", .shape = std::move(mesh)});
  return scene;
}

PixelRect part_of(const Camera& camera, const RayGenerator& rays, const Bvh& bvh,
                  const PixelRect& window) {
  const Box box = bvh.bounds().value();
  return occupied_part(camera, rays, box.lo, box.hi, window);
}

bool is_inside(const PixelRect& part, std::uint32_t x, std::uint32_t y) {
  return x >= part.x0 && x < part.x1 && y >= part.y0 && y < part.y1;
}

TEST(OccupiedPart, ContainsAllHits) {
  std::mt19937 random(1);
  const auto number = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  int smaller = 0, hits = 0;
  for (int round = 0; round < 300; ++round) {
    // Far from the origin, roundings of origins and directions are as large as pixels.
    const double far = round % 3 == 0 ? 0 : round % 3 == 1 ? 1e3 : 1e6;
    const DVec3 center = DVec3(number(), number(), number()) * far;
    const Scene scene = sphere(Vec3(center), 1);
    const Bvh bvh(scene);
    const double distance = 1 + 20 * std::abs(number());
    const DVec3 position = center + DVec3(number(), number(), number()) * distance;
    const DVec3 target = center + DVec3(number(), number(), number()) * 2.0;
    const PerspectiveCamera camera{
        .pose = {.position = position, .direction = target - position, .up = {0, 1, 0.01}},
        .vertical_fov = round % 7 == 0   ? 3
                        : round % 5 == 0 ? 1e-4
                                         : 1 + 0.9 * number()};
    const RayGenerator rays(camera, kPartSize);
    const PixelRect part = part_of(camera, rays, bvh, kWindow);
    if (part != kWindow) ++smaller;
    for (std::uint32_t y = 0; y < kPartSize.height; ++y) {
      for (std::uint32_t x = 0; x < kPartSize.width; ++x) {
        if (!bvh.intersect(rays(x + 0.5, y + 0.5))) continue;
        ++hits;
        ASSERT_TRUE(is_inside(part, x, y)) << round << ": " << x << ", " << y;
      }
    }
  }
  EXPECT_GT(smaller, 100);
  EXPECT_GT(hits, 10000);
}

TEST(OccupiedPart, FitsTightly) {
  const Scene scene = sphere(Vec3(0), 1);
  const Bvh bvh(scene);
  const PerspectiveCamera camera{.pose = {.position = {0, 0, 50}, .direction = {0, 0, -1}}};
  const RayGenerator rays(camera, kPartSize);
  const PixelRect part = part_of(camera, rays, bvh, kWindow);
  EXPECT_LT(part.size().width, 10U);
  EXPECT_LT(part.size().height, 10U);
  EXPECT_TRUE(is_inside(part, kPartSize.width / 2, kPartSize.height / 2));
  const PixelRect corner{.x0 = 0, .y0 = 0, .x1 = 16, .y1 = 16};
  EXPECT_FALSE(overlap(corner, part_of(camera, rays, bvh, corner)));
}

TEST(OccupiedPart, IsTheWindowForOtherCameras) {
  const Scene scene = sphere(Vec3(0), 1);
  const Pose outside{.position = {0, 0, 50}, .direction = {0, 0, -1}};
  const auto part = [&](const Camera& camera) {
    return part_of(camera, RayGenerator(camera, kPartSize), Bvh(scene), kWindow);
  };
  EXPECT_NE(part(PerspectiveCamera{.pose = outside}), kWindow);
  EXPECT_EQ(part(PerspectiveCamera{.pose = {.position = {0, 0, 0.5}}}), kWindow);
  EXPECT_EQ(part(OrthographicCamera{.pose = outside}), kWindow);
  EXPECT_EQ(part(EnvironmentCamera{.pose = outside}), kWindow);
  EXPECT_EQ(part(CalibratedCamera{.pose = outside}), kWindow);
}

}  // namespace
}  // namespace microtrace
