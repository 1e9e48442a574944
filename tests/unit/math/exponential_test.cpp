#include "scene/math/exponential.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

// The reference comes from the C library's long double functions, which have 11 more bits.
double units_in_last_place(double value, long double exact) {
  const double near = std::abs(static_cast<double>(exact));
  const double ulp = std::nextafter(near, HUGE_VAL) - near;
  return static_cast<double>(std::abs(static_cast<long double>(value) - exact)) / ulp;
}

TEST(Exponential, PowersStayWithinTwoUnitsInTheLastPlace) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> wide(-1000, 1000), narrow(-1, 1);
  for (int i = 0; i < 200000; ++i) {
    const double x = i % 2 == 0 ? wide(random) : narrow(random);
    ASSERT_LE(units_in_last_place(power_of_two(x), std::exp2(static_cast<long double>(x))), 2) << x;
  }
}

TEST(Exponential, LogarithmsStayWithinTheirBound) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> exponent(-1000, 1000), near(0.25, 4);
  for (int i = 0; i < 200000; ++i) {
    const double x = i % 2 == 0 ? std::exp2(exponent(random)) : near(random);
    const long double exact = std::log2(static_cast<long double>(x));
    const double size = std::abs(static_cast<double>(exact));
    const double bound = size < 1 ? 0x1p-52 : 0x1p-51 * size;
    ASSERT_NEAR(binary_logarithm(x), static_cast<double>(exact), bound) << x;
  }
}

TEST(Exponential, WholePowersAreExact) {
  for (int k = -1000; k <= 1000; ++k) {
    EXPECT_EQ(power_of_two(k), std::ldexp(1.0, k));
    EXPECT_EQ(binary_logarithm(std::ldexp(1.0, k)), k);
  }
}

TEST(Exponential, NaturalExponentialsAndPowersAgreeWithTheLibrary) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> argument(-690, 690), base(0.01, 1), exponent(0.01, 100);
  for (int i = 0; i < 100'000; ++i) {
    const double x = argument(random), b = base(random), y = exponent(random);
    ASSERT_NEAR(exponential(x) / std::exp(x), 1, 1e-12) << x;
    ASSERT_NEAR(power(b, y) / std::pow(b, y), 1, 1e-12) << b << ' ' << y;
  }
  EXPECT_EQ(exponential(0), 1);
  EXPECT_EQ(exponential(-1e300), 0);
  EXPECT_EQ(power(0, 2), 0);
  EXPECT_EQ(power(1, 1e6), 1);
  EXPECT_EQ(power(0.5, 1e6), 0);
}

}  // namespace
}  // namespace microtrace
