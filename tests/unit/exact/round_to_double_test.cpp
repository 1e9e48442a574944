#include "exact/numbers/round_to_double.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace microtrace::exact {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLeast = std::numeric_limits<double>::denorm_min();
constexpr double kGreatest = std::numeric_limits<double>::max();

Dyadic product(double x, double y) {
  return Dyadic(x) * Dyadic(y);
}

TEST(RoundToDouble, KeepsDoubles) {
  for (const double x : {0.0, 1.0, -0.1, 1e300, -1e-300, kLeast, 3 * kLeast, kGreatest, -kGreatest})
    EXPECT_EQ(round_to_double(Dyadic(x)), x);
}

TEST(RoundToDouble, RoundsQuotientsAsIeee754) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> number(-2, 2), exponent(-60, 60);
  for (int i = 0; i < 2000; ++i) {
    const double p = std::exp2(exponent(random)) * number(random);
    const double r = std::exp2(exponent(random)) * number(random);
    EXPECT_EQ(round_to_double(rational(Dyadic(p), Dyadic(r))), p / r) << p << " / " << r;
  }
}

TEST(RoundToDouble, RoundsSquareRootsAsIeee754) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> number(0, 1e6);
  for (int i = 0; i < 2000; ++i) {
    const double q = number(random);
    EXPECT_EQ(round_to_double(Root{0.0F, Dyadic(q), 1.0F, 1}), std::sqrt(q));
    EXPECT_EQ(round_to_double(Root{0.0F, Dyadic(q), 1.0F, -1}), -std::sqrt(q));
  }
}

TEST(RoundToDouble, RoundsTiesToEven) {
  const Dyadic half_step(0x1p-53);
  EXPECT_EQ(round_to_double(Dyadic(1.0) + half_step), 1.0);
  EXPECT_EQ(round_to_double(Dyadic(1 + 0x1p-52) + half_step), 1 + 0x1p-51);
  EXPECT_EQ(round_to_double(-(Dyadic(1 + 0x1p-52) + half_step)), -(1 + 0x1p-51));
  const Dyadic above = half_step + product(0x1p-1000, 0x1p-1000);
  EXPECT_EQ(round_to_double(Dyadic(1.0) + above), 1 + 0x1p-52);
}

TEST(RoundToDouble, HandlesTheEndsOfTheRange) {
  EXPECT_EQ(round_to_double(product(0x1p-1074, 0.5)), 0);
  EXPECT_EQ(round_to_double(product(0x1p-1074, 0.75)), kLeast);
  EXPECT_EQ(round_to_double(product(0x1p-1074, 1.5)), 2 * kLeast);
  EXPECT_EQ(round_to_double(product(0x1p-1074, -2.5)), -2 * kLeast);
  EXPECT_EQ(round_to_double(product(0x1p-1074, 0x1p-1000)), 0);
  // The midpoint of the greatest number and 2^1024 is rounded to infinity.
  EXPECT_EQ(round_to_double(Dyadic(kGreatest) + Dyadic(0x1p970)), kInfinity);
  EXPECT_EQ(round_to_double(Dyadic(kGreatest) + Dyadic(std::nextafter(0x1p970, 0.0))), kGreatest);
  EXPECT_EQ(round_to_double(product(-0x1p1000, 0x1p1000)), -kInfinity);
}

}  // namespace
}  // namespace microtrace::exact
