#include "scene/math/revolutions.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

TEST(Revolutions, ArctangentIsTrueToItsBound) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> linear(-1, 1), exponent(-30, 30);
  for (int i = 0; i < 300000; ++i) {
    const float scale = i % 2 == 0 ? 1 : std::exp2(exponent(random));
    const float y = linear(random) * scale, x = linear(random);
    ASSERT_NEAR(atan2_revolutions(y, x), std::atan2(double{y}, double{x}) / kTurn, 1e-7)
        << y << ' ' << x;
  }
}

TEST(Revolutions, ArctangentOfTheAxesIsExact) {
  EXPECT_EQ(atan2_revolutions(0, 0), 0);
  EXPECT_EQ(atan2_revolutions(0, 2), 0);
  EXPECT_EQ(atan2_revolutions(3, 0), 0.25F);
  EXPECT_EQ(atan2_revolutions(-3, 0), -0.25F);
  EXPECT_EQ(atan2_revolutions(0, -1), 0.5F);
  EXPECT_NEAR(atan2_revolutions(5, 5), 0.125, 1e-8);
}

TEST(Revolutions, SineAndCosineAreTrueToTheirBound) {
  for (int i = 0; i <= 1 << 20; ++i) {
    const float revolutions = static_cast<float>(i) * 0x1p-20F;
    const auto [sine, cosine] = sin_cos_revolutions(revolutions);
    ASSERT_NEAR(sine, std::sin(revolutions * kTurn), 0x1p-23) << revolutions;
    ASSERT_NEAR(cosine, std::cos(revolutions * kTurn), 0x1p-23) << revolutions;
  }
}

TEST(Revolutions, QuartersAreExact) {
  const float sines[] = {0, 1, 0, -1, 0, 1};
  for (int k = 0; k <= 4; ++k) {
    const auto [sine, cosine] = sin_cos_revolutions(0.25F * static_cast<float>(k));
    EXPECT_EQ(sine, sines[k]);
    EXPECT_EQ(cosine, sines[k + 1]);
  }
}

}  // namespace
}  // namespace microtrace
