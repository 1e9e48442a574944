/// Compares Dyadic and Root with CGAL's rationals and square-root extensions.

#include "exact/numbers/root.hpp"
#include "oracle/real_roots.hpp"
#include "oracle/rounding_check.hpp"
#include "support/effort.hpp"

#include <gtest/gtest.h>

namespace microtrace::oracle {
namespace {

using adversarial::Random;
using exact::Dyadic;
using exact::Root;

/// A Dyadic and a CGAL number with the same value.
struct Twin {
  Dyadic dyadic;
  Rational rational;
};

Twin twin(float x) {
  return {x, Rational(double{x})};
}

/// Evaluates a random polynomial expression of float32 numbers with the given degree.
Twin expression(Random& random, int degree, int lo, int hi) {
  if (degree == 1) return twin(random.any_float(lo, hi));
  const int left = random.between(1, degree - 1);
  const Twin x = expression(random, left, lo, hi);
  const Twin y = expression(random, degree - left, lo, hi);
  Twin product{x.dyadic * y.dyadic, x.rational * y.rational};
  const Twin term = expression(random, degree / 2, lo, hi);
  if (random.one_in(2)) return {product.dyadic + term.dyadic, product.rational + term.rational};
  return {term.dyadic - product.dyadic, term.rational - product.rational};
}

TEST(DyadicOracle, ArithmeticAndOrderEqualRationals) {
  Random random = announced_random(300);
  const int count = case_count(0.01);
  Twin previous = twin(0);
  for (int i = 0; i < count; ++i) {
    const bool full_range = random.one_in(2);
    const int lo = full_range ? -149 : -20, hi = full_range ? 127 : 20;
    const Twin x = expression(random, random.between(1, 24), lo, hi);
    ASSERT_EQ(to_rational(x.dyadic), x.rational);
    ASSERT_EQ(x.dyadic.sign(), CGAL::sign(x.rational));
    ASSERT_EQ(compare(x.dyadic, previous.dyadic), CGAL::compare(x.rational, previous.rational));
    ASSERT_EQ(compare(-x.dyadic, x.dyadic), -CGAL::sign(x.rational));
    previous = x;
  }
}

TEST(DyadicOracle, LeadingBitsBoundTheMagnitude) {
  Random random = announced_random(301);
  for (int i = 0; i < case_count(0.01); ++i) {
    const Twin x = expression(random, random.between(1, 3), -149, 127);
    if (x.dyadic.sign() == 0) continue;
    const auto [mantissa, exponent] = x.dyadic.leading();
    ASSERT_GE(mantissa, 0.5);
    ASSERT_LT(mantissa, 1.0);
    // Multiplies in two steps, because 2^exponent may be beyond double's range.
    const Rational half_scale = Rational(std::ldexp(1.0, exponent / 2));
    const Rational scale = half_scale * Rational(std::ldexp(1.0, exponent - exponent / 2));
    ASSERT_LE(Rational(mantissa) * scale, CGAL::abs(x.rational));
    ASSERT_LT(CGAL::abs(x.rational), Rational(mantissa + 0x1p-53) * scale);
  }
}

Dyadic integer(Random& random, int lo, int hi) {
  return static_cast<float>(random.between(lo, hi));
}

/// Returns a root of small integers. Numbers that are equal but have different forms are frequent,
/// for example sqrt(8) / 2 and sqrt(2).
Root small_root(Random& random) {
  return {integer(random, -8, 8), integer(random, 0, 50), integer(random, 1, 6),
          random.between(-1, 1)};
}

/// Returns a root whose parts have the degrees and magnitudes of a quadric's root.
Root large_root(Random& random, int lo, int hi) {
  const Dyadic p = expression(random, 3, lo, hi).dyadic;
  Dyadic q = expression(random, 6, lo, hi).dyadic;
  Dyadic r = expression(random, 3, lo, hi).dyadic;
  if (q.sign() < 0) q = -q;
  if (r.sign() < 0) r = -r;
  if (r.sign() == 0) r = 1.0f;
  return {p, q, r, random.between(-1, 1)};
}

int sign(std::strong_ordering order) {
  return order < 0 ? -1 : order > 0;
}

void check(const Root& x, const Root& y) {
  const Real a = to_real(x), b = to_real(y);
  ASSERT_EQ(sign(x <=> y), CGAL::compare(a, b)) << a << " against " << b;
  ASSERT_EQ(x == y, CGAL::compare(a, b) == 0) << a << " against " << b;
  ASSERT_TRUE(is_enclosed(a, enclose(x))) << a;
  ASSERT_TRUE(is_nearest(round_to_float(x), a)) << a;
}

TEST(RootOracle, OrderOfSmallRoots) {
  Random random = announced_random(302);
  int ties = 0;
  for (int i = 0; i < case_count(0.2) && !HasFatalFailure(); ++i) {
    const Root x = small_root(random), y = small_root(random);
    check(x, y);
    ties += x == y;
  }
  EXPECT_GT(ties, case_count(0.0005));
}

TEST(RootOracle, OrderOfLargeRootsAndOfNearlyEqualOnes) {
  Random random = announced_random(303);
  for (int i = 0; i < case_count(0.005) && !HasFatalFailure(); ++i) {
    const bool full_range = random.one_in(2);
    const int lo = full_range ? -149 : -9, hi = full_range ? 127 : 9;
    const Root x = large_root(random, lo, hi), y = large_root(random, lo, hi);
    check(x, y);
    // First compares the root with an equal number in another form, then with a number that differs
    // from it in a very low bit.
    const Dyadic k = 3.0f;
    Root z{x.p * k, x.q * k * k, x.r * k, x.sign};
    check(x, z);
    z.q = z.q + x.q * Dyadic(0x1p-90f);
    check(x, z);
  }
}

TEST(RootOracle, RoundingAtMidpointsOfFloats) {
  Random random = announced_random(304);
  for (int i = 0; i < case_count(0.02) && !HasFatalFailure(); ++i) {
    const float f = random.any_float(-149, 127);
    const Dyadic middle = (double{f} + double{adversarial::moved(f, 1)}) / 2;
    const Dyadic r = 3.0f;
    const Dyadic nudge = static_cast<float>(random.between(-1, 1)) * Dyadic(0x1p-140f) * Dyadic(f);
    const Root rational{middle * r + nudge, {}, r, 0};
    check(rational, exact::rational(f));
    // The same number as a square root: sqrt((middle r + nudge)^2) / r.
    const Root irrational{{}, square(middle * r + nudge), r, middle.sign()};
    check(irrational, rational);
  }
}

}  // namespace
}  // namespace microtrace::oracle
