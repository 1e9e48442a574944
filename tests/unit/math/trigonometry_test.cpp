#include "scene/math/trigonometry.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

// The reference comes from the C library's long double functions, which have 11 more bits.
double ulps_of(double value, long double exact) {
  const double ulp = std::nextafter(std::abs(static_cast<double>(exact)), HUGE_VAL) -
                     std::abs(static_cast<double>(exact));
  return static_cast<double>(std::abs(static_cast<long double>(value) - exact)) / ulp;
}

TEST(Trigonometry, StaysWithinTwoUnitsInTheLastPlace) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> angle(-50, 50);
  for (int i = 0; i < 200000; ++i) {
    const double x = angle(random);
    const long double l = x;
    ASSERT_LE(ulps_of(sin_radians(x), std::sin(l)), 2) << x;
    ASSERT_LE(ulps_of(cos_radians(x), std::cos(l)), 2) << x;
    ASSERT_LE(ulps_of(tan_radians(x), std::tan(l)), 4) << x;
  }
}

TEST(Trigonometry, DegreesAgreeWithRadians) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> angle(-1000, 1000);
  for (int i = 0; i < 100000; ++i) {
    const double x = angle(random);
    const long double l = static_cast<long double>(x) * (std::numbers::pi_v<long double> / 180);
    ASSERT_NEAR(sin_degrees(x), static_cast<double>(std::sin(l)), 4e-16) << x;
    ASSERT_NEAR(cos_degrees(x), static_cast<double>(std::cos(l)), 4e-16) << x;
  }
}

TEST(Trigonometry, MultiplesOf90DegreesAreExact) {
  for (int k = -1000; k <= 1000; ++k) {
    const double sines[] = {0, 1, 0, -1};
    EXPECT_EQ(sin_degrees(90.0 * k), sines[k & 3]);
    EXPECT_EQ(cos_degrees(90.0 * k), sines[(k + 1) & 3]);
  }
}

TEST(Trigonometry, ArctangentStaysWithinFourUnitsInTheLastPlace) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> angle(-1.57, 1.57), exponent(-300, 300);
  for (int i = 0; i < 200000; ++i) {
    const double x = i % 2 == 0 ? std::tan(angle(random)) : std::pow(10.0, exponent(random));
    ASSERT_LE(ulps_of(atan_radians(x), std::atan(static_cast<long double>(x))), 4) << x;
  }
  EXPECT_EQ(atan_radians(0), 0);
  EXPECT_EQ(atan_radians(HUGE_VAL), std::numbers::pi / 2);
  EXPECT_EQ(atan_radians(-HUGE_VAL), -std::numbers::pi / 2);
}

TEST(Trigonometry, AnglesOfVectorsAreInAllQuadrants) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 100000; ++i) {
    const double x = normal(random), y = normal(random);
    ASSERT_NEAR(atan2_radians(y, x), std::atan2(y, x), 1e-15) << y << " " << x;
  }
  constexpr double kPi = std::numbers::pi;
  EXPECT_EQ(atan2_radians(0, 0), 0);
  EXPECT_EQ(atan2_radians(0, 2), 0);
  EXPECT_EQ(atan2_radians(0, -2), kPi);
  EXPECT_EQ(atan2_radians(3, 0), kPi / 2);
  EXPECT_EQ(atan2_radians(-3, -0.0), -kPi / 2);
}

TEST(Trigonometry, HalfAngles) {
  EXPECT_NEAR(sin_degrees(30), 0.5, 1e-16);
  EXPECT_NEAR(tan_radians(radians_from_degrees(45)), 1, 2e-16);
}

}  // namespace
}  // namespace microtrace
