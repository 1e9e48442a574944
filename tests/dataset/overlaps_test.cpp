// Checks the numbers of objects that rays can hit.

#include "dataset/annotations/overlaps.hpp"

#include <microtrace/bvh.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>
#include <variant>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace microtrace::dataset {
namespace {

bool contains(const PixelRect& part, std::uint32_t x, std::uint32_t y) {
  return x >= part.x0 && x < part.x1 && y >= part.y0 && y < part.y1;
}

TEST(Overlaps, CountThePartsThatContainAPixel) {
  std::mt19937 random(1);
  const PixelRect window{.x0 = 3, .y0 = 5, .x1 = 40, .y1 = 31};
  for (int round = 0; round < 50; ++round) {
    std::vector<PixelRect> parts(random() % 12);
    for (PixelRect& part : parts) {
      // Some parts are empty, or extend beyond the window.
      part = {.x0 = std::uint32_t(random() % 50),
              .y0 = std::uint32_t(random() % 40),
              .x1 = std::uint32_t(random() % 50),
              .y1 = std::uint32_t(random() % 40)};
    }
    const Overlaps overlaps(parts, window);
    PixelRect several{.x0 = window.x1, .y0 = window.y1, .x1 = window.x0, .y1 = window.y0};
    for (std::uint32_t y = window.y0; y < window.y1; ++y) {
      for (std::uint32_t x = window.x0; x < window.x1; ++x) {
        const auto expected = std::ranges::count_if(
            parts, [&](const PixelRect& part) { return contains(part, x, y); });
        ASSERT_EQ(overlaps.at(x, y), expected) << x << ", " << y;
        if (expected < 2) continue;
        several = {.x0 = std::min(several.x0, x),
                   .y0 = std::min(several.y0, y),
                   .x1 = std::max(several.x1, x + 1),
                   .y1 = std::max(several.y1, y + 1)};
      }
    }
    EXPECT_EQ(overlaps.several(), several);
  }
}

TEST(Overlaps, PartsContainAllHitsOfTheirObjects) {
  constexpr ImageSize kSize{.width = 64, .height = 48};
  const PixelRect window{.x0 = 0, .y0 = 0, .x1 = kSize.width, .y1 = kSize.height};
  Scene scene;
  const auto add = [&](Shape shape) { scene.objects.push_back({.name = "", .shape = shape}); };
  add(Mesh{.positions = {{-1, -1, -5}, {1, -1, -5}, {0, 1, -6}}, .triangles = {{0, 1, 2}}});
  add(Mesh{.positions = {{1, 0, -3}, {2, 0, -3}, {2, 1, -4}}, .triangles = {{0, 1, 2}}});
  add(Sphere{.center = {-2, 0, -7}, .radius = 1});
  add(Plane{.point = {0, -2, 0}, .normal = {0, 1, 0}});
  add(Mesh{});
  // The first mesh, upside down and to the right, where the mesh itself isn't.
  Mesh placed = std::get<Mesh>(scene.objects[0].shape);
  placed.placement = std::make_shared<const Placement>(
      glm::scale(glm::translate(DMat4(1), DVec3(4, 0, -4)), DVec3(1, -1, 1)));
  add(placed);
  const Camera camera = PerspectiveCamera{};
  const RayGenerator rays(camera, kSize);
  const std::vector<PixelRect> parts = parts_of_objects(scene, camera, rays, window);
  ASSERT_EQ(parts.size(), scene.objects.size());
  EXPECT_LT(parts[0].size().width, kSize.width);
  EXPECT_EQ(parts[3], window);
  EXPECT_FALSE(contains(parts[4], 0, 0));
  EXPECT_LT(parts[5].size().width, kSize.width / 2);
  EXPECT_LT(parts[5].size().height, kSize.height / 2);
  const Bvh bvh(scene);
  std::vector<int> hits(parts.size());
  for (std::uint32_t y = 0; y < kSize.height; ++y) {
    for (std::uint32_t x = 0; x < kSize.width; ++x) {
      const Ray ray = rays(x + 0.5, y + 0.5);
      for (auto hit = bvh.intersect(ray); hit; hit = bvh.next(ray, *hit)) {
        const std::size_t object = bvh.primitives().object_index(hit->id);
        ++hits[object];
        ASSERT_TRUE(contains(parts[object], x, y)) << object << ": " << x << ", " << y;
      }
    }
  }
  for (const std::size_t object : {0U, 1U, 2U, 3U, 5U}) EXPECT_GT(hits[object], 0) << object;
}

}  // namespace
}  // namespace microtrace::dataset
