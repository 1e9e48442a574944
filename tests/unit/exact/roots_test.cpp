#include "scene/math/roots.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// Returns the polynomial with coefficients c, constant term first, multiplied by (1 - x / root).
std::vector<double> with_root(const std::vector<double>& c, double root) {
  std::vector<double> product(c.size() + 1);
  for (std::size_t i = 0; i < c.size(); ++i) {
    product[i] += c[i];
    product[i + 1] -= c[i] / root;
  }
  return product;
}

TEST(LeastPositiveRoot, FindsTheLeastOfSeveral) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-3, 3);
  for (int i = 0; i < 1000; ++i) {
    std::vector<double> c{1};
    double least = HUGE_VAL;
    for (int k = 0; k < 3; ++k) {
      const double root = std::pow(10, exponent(random));
      least = std::min(least, root);
      c = with_root(with_root(c, root), -std::pow(10, exponent(random)));
    }
    const double found = least_positive_root(c);
    EXPECT_LE(found, least * (1 + 1e-9));
    EXPECT_NEAR(found, least, 1e-6 * least) << i;
  }
}

TEST(LeastPositiveRoot, IsInfiniteWithoutRoots) {
  EXPECT_EQ(least_positive_root({1}), HUGE_VAL);
  EXPECT_EQ(least_positive_root({1, 2, 3}), HUGE_VAL);
  EXPECT_EQ(least_positive_root({1, -1, 1}), HUGE_VAL);         // complex roots
  EXPECT_EQ(least_positive_root({1, -2, 1 + 1e-9}), HUGE_VAL);  // nearly touches zero at x = 1
  EXPECT_EQ(least_positive_root({1, 0, 0, 0}), HUGE_VAL);
}

TEST(LeastPositiveRoot, OfTinyAndHugeRoots) {
  EXPECT_NEAR(least_positive_root({1, -1e-6}), 1e6, 1e-2);
  EXPECT_NEAR(least_positive_root({1, -1e6}), 1e-6, 1e-14);
  EXPECT_EQ(least_positive_root({1, -1e30}), 0);  // the lower bound underflows to 0
  EXPECT_NEAR(least_positive_root({1, 0, -4}), 0.5, 1e-14);
}

TEST(SolveIncreasing, SolvesToRounding) {
  const auto cube = [](double x) {
    return ValueAndSlope{.value = x + x * x * x, .slope = 1 + 3 * x * x};
  };
  for (const double y : {1e-300, 1e-9, 0.3, 1.0, 7.0, 1e5, 9.9e17}) {
    const double x = solve_increasing(cube, y, 0, 1e6);
    EXPECT_NEAR((x + x * x * x) / y, 1, 1e-15) << y;
  }
  // The slope of this function is 0 at the end of the interval.
  const auto fold = [](double x) {
    return ValueAndSlope{.value = x - x * x * x / 3, .slope = 1 - x * x};
  };
  for (const double gap : {0.0, 1e-15, 1e-9, 1e-3}) {
    const double x = solve_increasing(fold, 2.0 / 3 - gap, 0, 1);
    EXPECT_NEAR(x - x * x * x / 3, 2.0 / 3 - gap, 2e-16);
    EXPECT_LE(x, 1);
  }
}

}  // namespace
}  // namespace microtrace
