#include "exact/numbers/dyadic.hpp"

#include "support/cases/adversarial_rays.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace microtrace::exact {
namespace {

__extension__ using Int128 = __int128;

int sign(Int128 x) {
  return x < 0 ? -1 : x > 0;
}

/// Converts x to a Dyadic, 40 bits at a time.
Dyadic dyadic(Int128 x) {
  const Int128 magnitude = x < 0 ? -x : x;
  Dyadic sum;
  for (int shift = 0; shift < 128; shift += 40) {
    const auto digit = static_cast<std::uint64_t>(magnitude >> shift) & 0xffffffffffu;
    sum = sum + Dyadic(std::ldexp(static_cast<double>(digit), shift));
  }
  return x < 0 ? -sum : sum;
}

TEST(Dyadic, AgreesWithInt128) {
  adversarial::Random random(1);
  const auto integer = [&] {  // at most 62 bits, sometimes only a few
    const Int128 high = random.bits(), low = random.bits();
    const Int128 x = (high << 30 | low >> 2) >> random.between(0, 61);
    return random.one_in(2) ? x : -x;
  };
  for (int i = 0; i < 100000; ++i) {
    const Int128 a = integer(), b = integer(), c = integer(), d = integer();
    const Dyadic x = dyadic(a) * dyadic(b) - dyadic(c) * dyadic(d) + dyadic(a);
    const Int128 expected = a * b - c * d + a;
    ASSERT_EQ(compare(x, dyadic(expected)), 0);
    ASSERT_EQ(x.sign(), sign(expected));
    ASSERT_EQ(compare(dyadic(a), dyadic(b)), sign(a - b));
  }
}

TEST(Dyadic, IsExactForEveryKindOfFloat) {
  constexpr float least = std::numeric_limits<float>::denorm_min();
  constexpr float largest = std::numeric_limits<float>::max();
  for (const float x : {0.0f, -0.0f, 1.0f, -1.5f, least, -3 * least, 0x1p-126f, largest}) {
    EXPECT_EQ(compare(Dyadic(x), Dyadic(double{x})), 0) << x;
    EXPECT_EQ(Dyadic(x).sign(), x < 0 ? -1 : x > 0) << x;
  }
  // 2^149 times the smallest float32 is one.
  EXPECT_EQ(compare(Dyadic(least) * Dyadic(0x1p149), Dyadic(1.0f)), 0);
  EXPECT_EQ(compare(Dyadic(0x1p-1074) * Dyadic(0x1p1023) * Dyadic(0x1p51), Dyadic(1.0f)), 0);
}

TEST(Dyadic, KeepsBitsFarBelowTheLeadingOne) {
  const Dyadic large = std::numeric_limits<float>::max();
  const Dyadic small = std::numeric_limits<float>::denorm_min();
  EXPECT_EQ(compare(large + small - large, small), 0);
  EXPECT_EQ(compare(large + small, large), 1);
  EXPECT_EQ(compare(small - large, -large), 1);
}

TEST(Dyadic, ZeroAndCancelledNumbersHaveNoLimbs) {
  const Dyadic x = 0x1.8p77f;
  EXPECT_EQ((x - x).limbs().size(), 0u);
  EXPECT_EQ((x - x).sign(), 0);
  EXPECT_EQ((x * Dyadic(0.0f)).limbs().size(), 0u);
  EXPECT_EQ(compare(x + Dyadic(), x), 0);
  EXPECT_EQ(compare(Dyadic() - x, -x), 0);
}

TEST(Dyadic, OrdinaryNumbersStayShort) {
  const Dyadic x = 0.37f, y = -1.71f, z = 12.125f;
  EXPECT_LE((x * y * z + x - y).limbs().size(), 3u);
  EXPECT_EQ(Dyadic(0x1p-128f).limbs().size(), 1u);
}

/// The largest expression in a comparison of roots, with all bits set: 2^37 - 1 times the 24th
/// power of a number that spans all bits of float32.
TEST(Dyadic, HoldsTheLargestForm) {
  const Dyadic x = Dyadic(0x1p128) - Dyadic(std::numeric_limits<float>::denorm_min());
  const Dyadic x2 = square(x), x4 = square(x2), x8 = square(x4), x12 = x8 * x4;
  const Dyadic form = Dyadic(0x1.fffffffffp36) * x12 * x12;
  EXPECT_EQ(form.limbs().size(), 105u);
  EXPECT_LE(form.limbs().size() + 2, static_cast<std::size_t>(Dyadic::kCapacity));
  // (x12 - 1) (x12 + 1) = x12^2 - 1 only if no bit is lost.
  const Dyadic one = 1.0f;
  EXPECT_EQ(compare((x12 - one) * (x12 + one), x12 * x12 - one), 0);
}

}  // namespace
}  // namespace microtrace::exact
