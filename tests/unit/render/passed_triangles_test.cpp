// Tests the notes of blended and clear triangles that shadow rays pass.

#include "render/shading/transmittance.hpp"

#include <algorithm>
#include <random>
#include <ranges>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr auto any_triangle = [](PrimitiveId) { return true; };

// A triangle with references in several leaves of the tree is met several times.
TEST(PassedTriangles, CountEachTriangleOnce) {
  PassedTriangles passed;
  const Vec3 red(0.75F, 0.25F, 0), gray(0.5F);
  passed.add(3, red);
  passed.add(3, red);
  EXPECT_EQ(passed.transmittance(any_triangle), red);
  passed.add(5, gray);
  passed.add(3, red);
  passed.add(5, gray);
  EXPECT_EQ(passed.transmittance(any_triangle), 0.5F * red);
  EXPECT_TRUE(passed.is_complete());
  EXPECT_EQ(passed.transmittance([](PrimitiveId id) { return id == 5; }), gray);
  passed.clear();
  EXPECT_EQ(passed.transmittance(any_triangle), Vec3(1));
}

TEST(PassedTriangles, HaveTheSameProductInEachOrder) {
  std::vector<std::pair<PrimitiveId, float>> triangles;
  for (PrimitiveId id = 0; id < PassedTriangles::kMost; ++id)
    triangles.emplace_back(id, 0.9F - 0.05F * static_cast<float>(id * 5 % 17));
  float product = 1, in_reverse = 1;
  for (const auto& [id, light] : triangles) product *= light;
  for (const auto& [id, light] : triangles | std::views::reverse) in_reverse *= light;
  EXPECT_NE(product, in_reverse);
  std::mt19937 random(1);
  for (int round = 0; round < 100; ++round) {
    std::shuffle(triangles.begin(), triangles.end(), random);
    PassedTriangles passed;
    for (const auto& [id, light] : triangles) passed.add(id, Vec3(light));
    ASSERT_TRUE(passed.is_complete());
    ASSERT_EQ(passed.transmittance(any_triangle), Vec3(product));
  }
}

TEST(PassedTriangles, TellWhenSomeAreMissing) {
  PassedTriangles passed;
  for (PrimitiveId id = 0; id < PassedTriangles::kMost; ++id) passed.add(id, Vec3(0.5F));
  passed.add(3, Vec3(0.5F));
  EXPECT_TRUE(passed.is_complete());
  passed.add(PassedTriangles::kMost, Vec3(0.5F));
  EXPECT_FALSE(passed.is_complete());
  passed.add(PassedTriangles::kMost, Vec3(0.5F));
  EXPECT_FALSE(passed.is_complete());
}

}  // namespace
}  // namespace microtrace
