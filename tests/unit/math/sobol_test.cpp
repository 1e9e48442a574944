#include "render/sampling/sobol.hpp"

#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace::sampling {
namespace {

std::vector<Vec2> points(std::uint32_t count, std::uint32_t pair, std::uint32_t seed = 0) {
  std::vector<Vec2> result;
  for (std::uint32_t k = 0; k < count; ++k)
    result.push_back(Sobol(pixel_key(seed, 3, 7), k).pair(pair));
  return result;
}

// Checks I. Sobol's definition of a (0, m, 2)-net: every elementary interval of area 2^-m contains
// exactly one point.
TEST(Sobol, EveryPairIsANetInBaseTwo) {
  constexpr std::uint32_t bits = 8, count = 1U << bits;
  for (std::uint32_t pair = 0; pair < 20; ++pair) {
    const std::vector<Vec2> p = points(count, pair);
    for (std::uint32_t across = 0; across <= bits; ++across) {
      const float columns = static_cast<float>(1U << across);
      const float rows = static_cast<float>(1U << (bits - across));
      std::set<std::pair<int, int>> cells;
      for (const Vec2& q : p)
        cells.emplace(static_cast<int>(q.x * columns), static_cast<int>(q.y * rows));
      EXPECT_EQ(cells.size(), count) << "pair " << pair << ", columns " << columns;
    }
  }
}

TEST(Sobol, NumbersLieInTheHalfOpenUnitInterval) {
  for (const Vec2& p : points(4096, 5)) {
    EXPECT_GE(p.x, 0);
    EXPECT_LT(p.x, 1);
    EXPECT_GE(p.y, 0);
    EXPECT_LT(p.y, 1);
  }
}

// Estimates the mean product of two numbers from different pairs, which is 1/4 if they are
// independent. One product has the standard deviation sqrt(7) / 12.
TEST(Sobol, PairsAreIndependent) {
  constexpr std::uint32_t count = 1024, pixels = 64;
  for (std::uint32_t other = 1; other < 8; ++other) {
    double sum = 0;
    for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
      for (std::uint32_t k = 0; k < count; ++k) {
        const Sobol sobol(pixel_key(1, pixel, 0), k);
        sum += double{sobol.pair(0).x} * sobol.pair(other).x;
      }
    }
    const double n = count * pixels;
    EXPECT_NEAR(sum / n, 0.25, 5 * std::sqrt(7.0) / 12 / std::sqrt(n)) << other;
  }
}

TEST(Sobol, DependsOnSeedPixelAndPair) {
  const Vec2 base = Sobol(pixel_key(0, 1, 2), 3).pair(0);
  EXPECT_NE(base, Sobol(pixel_key(1, 1, 2), 3).pair(0));
  EXPECT_NE(base, Sobol(pixel_key(0, 2, 1), 3).pair(0));
  EXPECT_NE(base, Sobol(pixel_key(0, 1, 2), 4).pair(0));
  EXPECT_NE(base, Sobol(pixel_key(0, 1, 2), 3).pair(1));
}

TEST(Sobol, SingleNumberIsTheFirstOfThePair) {
  for (std::uint32_t k = 0; k < 100; ++k) {
    const Sobol sobol(pixel_key(9, 5, 5), k);
    EXPECT_EQ(sobol.one(4), sobol.pair(4).x);
  }
}

}  // namespace
}  // namespace microtrace::sampling
