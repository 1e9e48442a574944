#include "exact/numbers/root.hpp"

#include "support/cases/adversarial_rays.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace microtrace::exact {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Root number(double x) {
  return rational(Dyadic(x), Dyadic(1.0f));
}

/// (p + sign sqrt(q)) / r.
Root root(float p, int sign, float q, float r) {
  return {p, q, r, sign};
}

TEST(Root, OrdersRationals) {
  EXPECT_LT(rational(1.0f, 3.0f), rational(0.33333334f));
  EXPECT_GT(rational(1.0f, 3.0f), rational(0.33333331f));
  EXPECT_EQ(rational(1.0f, -3.0f), rational(-2.0f, 6.0f));
  EXPECT_EQ(rational(0.0f, 5.0f), rational(-0.0f));
}

TEST(Root, OrdersIrrationals) {
  const Root sqrt2 = root(0, 1, 2, 1);
  EXPECT_EQ(sqrt2, root(0, 1, 8, 2));
  EXPECT_EQ(root(-3, 1, 9, 1), rational(0.0f));
  EXPECT_GT(sqrt2, number(1.41421356237309492));
  EXPECT_LT(sqrt2, number(1.41421356237309515));
  EXPECT_LT(root(3, -1, 2, 1), root(3, 1, 2, 1));
  // Compares sqrt(2) + sqrt(3) with sqrt(10), and similar sums. Rearranged, each side is a root: 3
  // - sqrt(2) and 3 - sqrt(10) + sqrt(3).
  EXPECT_LT(root(-1, 1, 3, 1), root(0, 1, 2, 1));
  EXPECT_GT(root(-1, -1, 2, 1), root(-1, -1, 3, 1));
  EXPECT_LT(root(1, -1, 3, 2), root(5, -1, 17, 2));
}

TEST(Root, OrdersNumbersThatDifferInLowBits) {
  // sqrt(n^2 + 1) - n is approximately 1 / (2 n).
  const float n = 0x1p100f;
  const Root small{Dyadic(-n), square(n) + Dyadic(1.0f), 1.0f, 1};
  EXPECT_GT(small, rational(0.0f));
  EXPECT_LT(small, rational(0x1p-101f));
  EXPECT_GT(small, Root(rational(Dyadic(0x1p-101f) - Dyadic(0x1p-303), 1.0f)));
  const Enclosure e = enclose(small);
  EXPECT_LE(e.lo, 0x1p-101);
  EXPECT_GE(e.hi, 0x1p-101);
  EXPECT_LE(e.hi - e.lo, 0x1p-147);
}

TEST(Root, EnclosuresAreTight) {
  for (const double x : {1.0, -3.0, 0.1, 1e300, -1e-290}) {
    const Enclosure e = enclose(number(x));
    EXPECT_LT(e.lo, x);
    EXPECT_GT(e.hi, x);
    EXPECT_LE(e.hi - e.lo, std::abs(x) * 0x1p-47);
  }
  const Enclosure zero = enclose(root(-3, 1, 9, 1));
  EXPECT_EQ(zero.lo, 0);
  EXPECT_EQ(zero.hi, 0);
}

TEST(Root, EnclosuresAreClampedToTheRangeOfDouble) {
  const Dyadic large = square(square(Dyadic(0x1p800)));
  const Enclosure above = enclose(rational(large, 1.0f));
  EXPECT_GT(above.lo, 1e290);
  EXPECT_EQ(above.hi, kInfinity);
  const Enclosure below = enclose(rational(Dyadic(-1.0f), large));
  EXPECT_LT(below.lo, 0);
  EXPECT_GT(below.lo, -1e-290);
  EXPECT_EQ(below.hi, 0);
  EXPECT_EQ(round_to_float(rational(large, 1.0f)), std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::signbit(round_to_float(rational(Dyadic(-1.0f), large))));
}

TEST(Root, RoundsAsConversionFromDoubleDoes) {
  adversarial::Random random(2);
  for (int i = 0; i < 100000; ++i) {
    const float f = random.any_float(-149, 127);
    const double between = (double{f} + double{adversarial::moved(f, 1)}) / 2;
    for (const double x : {between, std::nextafter(between, kInfinity), double{f},
                           std::nextafter(between, -kInfinity), between * random.unit()}) {
      const float expected = x == 0 ? 0.0f : static_cast<float>(x);
      ASSERT_EQ(std::bit_cast<std::uint32_t>(round_to_float(number(x))),
                std::bit_cast<std::uint32_t>(expected))
          << std::hexfloat << x;
    }
  }
}

TEST(Root, RoundsAtTheEndsOfFloat) {
  constexpr float largest = std::numeric_limits<float>::max();
  constexpr float least = std::numeric_limits<float>::denorm_min();
  const double middle = 0x1p128 - 0x1p103;  // halfway between the largest float and 2^128
  EXPECT_EQ(round_to_float(number(middle)), std::numeric_limits<float>::infinity());
  EXPECT_EQ(round_to_float(number(-middle)), -std::numeric_limits<float>::infinity());
  EXPECT_EQ(round_to_float(number(std::nextafter(middle, 0.0))), largest);
  EXPECT_EQ(round_to_float(number(0x1p-150)), 0);
  EXPECT_EQ(round_to_float(number(std::nextafter(0x1p-150, 1.0))), least);
  EXPECT_EQ(round_to_float(number(0x1.8p-149)), 2 * least);
}

}  // namespace
}  // namespace microtrace::exact
