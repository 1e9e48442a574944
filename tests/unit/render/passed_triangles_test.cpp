// Tests the notes of blended triangles that shadow rays pass.

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
  passed.add(3, 0.25F);
  passed.add(3, 0.25F);
  EXPECT_EQ(passed.transmittance(any_triangle), 0.75F);
  passed.add(5, 0.5F);
  passed.add(3, 0.25F);
  passed.add(5, 0.5F);
  EXPECT_EQ(passed.transmittance(any_triangle), 0.375F);
  EXPECT_TRUE(passed.is_complete());
  EXPECT_EQ(passed.transmittance([](PrimitiveId id) { return id == 5; }), 0.5F);
  passed.clear();
  EXPECT_EQ(passed.transmittance(any_triangle), 1);
}

TEST(PassedTriangles, HaveTheSameProductInEachOrder) {
  std::vector<std::pair<PrimitiveId, float>> triangles;
  for (PrimitiveId id = 0; id < PassedTriangles::kMost; ++id)
    triangles.emplace_back(id, 0.1F + 0.05F * static_cast<float>(id * 7 % 13));
  float product = 1, in_reverse = 1;
  for (const auto& [id, coverage] : triangles) product *= 1 - coverage;
  for (const auto& [id, coverage] : triangles | std::views::reverse) in_reverse *= 1 - coverage;
  EXPECT_NE(product, in_reverse);
  std::mt19937 random(1);
  for (int round = 0; round < 100; ++round) {
    std::shuffle(triangles.begin(), triangles.end(), random);
    PassedTriangles passed;
    for (const auto& [id, coverage] : triangles) passed.add(id, coverage);
    ASSERT_TRUE(passed.is_complete());
    ASSERT_EQ(passed.transmittance(any_triangle), product);
  }
}

TEST(PassedTriangles, TellWhenSomeAreMissing) {
  PassedTriangles passed;
  for (PrimitiveId id = 0; id < PassedTriangles::kMost; ++id) passed.add(id, 0.5F);
  passed.add(3, 0.5F);
  EXPECT_TRUE(passed.is_complete());
  passed.add(PassedTriangles::kMost, 0.5F);
  EXPECT_FALSE(passed.is_complete());
  passed.add(PassedTriangles::kMost, 0.5F);
  EXPECT_FALSE(passed.is_complete());
}

}  // namespace
}  // namespace microtrace
