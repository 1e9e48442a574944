#include "exact/numbers/integer.hpp"

#include "exact/numbers/dyadic.hpp"
#include "support/cases/adversarial_rays.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace microtrace::exact {
namespace {

/// Converts x to a Dyadic, limb by limb.
template <int Limbs>
Dyadic dyadic(const Integer<Limbs>& x) {
  const Integer<Limbs> size = x.is_negative() ? -x : x;
  Dyadic sum(0.0F);
  for (std::size_t i = 0; i < Limbs; ++i) {
    const int place = static_cast<int>(64 * i);
    const Dyadic unit = Dyadic(std::ldexp(1.0, place));
    const std::uint64_t limb = size.limb(i);
    sum = sum + unit * (Dyadic(static_cast<double>(limb >> 32U)) * Dyadic(0x1p32) +
                        Dyadic(static_cast<double>(limb & 0xffffffffU)));
  }
  return x.is_negative() ? -sum : sum;
}

/// Random numbers of up to 2^120 in magnitude. Runs of ones and zeros cause long carries.
class Numbers {
 public:
  Integer<2> operator()() {
    const auto run = [this] {
      const int length = random_.between(0, 63);
      return (std::uint64_t{1} << static_cast<unsigned>(length)) - random_.bits() % 2;
    };
    const std::uint64_t magnitude = random_.one_in(3) ? run()
                                    : random_.one_in(8)
                                        ? 0
                                        : std::uint64_t{random_.bits()} << 32U | random_.bits();
    const auto high = Integer<2>::shifted(random_.one_in(2), magnitude, random_.between(0, 55));
    return random_.one_in(2) ? high : high + Integer<2>::shifted(random_.one_in(2), run(), 0);
  }
  adversarial::Random& random() { return random_; }

 private:
  adversarial::Random random_{1};
};

TEST(Integer, SumsAndProductsEqualDyadic) {
  Numbers number;
  for (int i = 0; i < 20000; ++i) {
    const Integer<2> a = number(), b = number(), c = number(), d = number(), e = number();
    ASSERT_EQ(compare(dyadic(a - b), dyadic(a) - dyadic(b)), 0);
    const auto area = a * b - c * d;
    const Dyadic exact_area = dyadic(a) * dyadic(b) - dyadic(c) * dyadic(d);
    ASSERT_EQ(compare(dyadic(area), exact_area), 0);
    const auto volume = e * area;
    ASSERT_EQ(compare(dyadic(volume), dyadic(e) * exact_area), 0);
    ASSERT_EQ(compare(dyadic(area * e), dyadic(volume)), 0);
    ASSERT_EQ(compare(dyadic(volume * volume - volume.widened<12>()),
                      square(dyadic(volume)) - dyadic(volume)),
              0);
    ASSERT_EQ(volume.sign(), dyadic(volume).sign());
    ASSERT_EQ((volume - volume).sign(), 0);
    const int shift = number.random().between(0, 255);
    ASSERT_EQ(compare(dyadic(volume.widened<11>() << shift),
                      dyadic(volume) * Dyadic(std::ldexp(1.0, shift))),
              0);
    if (volume.sign() == 0) continue;
    const Leading leading = volume.leading(), expected = dyadic(volume).leading();
    ASSERT_EQ(leading.mantissa, expected.mantissa);
    ASSERT_EQ(leading.exponent, expected.exponent);
  }
}

// The largest expressions of Grid, evaluated at the maximum coordinates, must not overflow.
TEST(Integer, HoldsTheLargestForms) {
  const auto most = Integer<2>::shifted(false, (std::uint64_t{1} << 56U) - 1, 64);  // < 2^120
  const auto difference = most - -most;
  const auto area = difference * difference - -(difference * difference);
  const auto volume = difference * area + difference * area + difference * area;
  const auto sum = volume + volume + volume;
  const auto order = volume * sum - -(volume * sum);
  for (const int sign : {area.sign(), volume.sign(), sum.sign(), order.sign()}) EXPECT_EQ(sign, 1);
  const Dyadic two_most = dyadic(most) + dyadic(most);
  const Dyadic cube = two_most * two_most * two_most;
  EXPECT_EQ(compare(dyadic(order), Dyadic(216.0F) * square(cube)), 0);
}

}  // namespace
}  // namespace microtrace::exact
