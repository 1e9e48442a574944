#include <microtrace/fixed_sum.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using Sum = FixedSum<2, 64>;

Sum sum_of(const std::vector<double>& terms) {
  Sum sum;
  for (const double x : terms) sum.add(x);
  return sum;
}

TEST(FixedSum, OneTermIsItself) {
  for (const double x : {1.0, 0.5, -3.25, 0x1p-64, -0x1p-64, 0x1.fffffffffffffp+61, -0x1p62,
                         0.1F * 1.0, 0x1.8p-63}) {
    EXPECT_EQ(sum_of({x}).value(), x) << x;
  }
}

TEST(FixedSum, TermsBelowTheUnitAreTruncated) {
  EXPECT_EQ(sum_of({0x1p-65}), Sum{});
  EXPECT_EQ(sum_of({-0x1p-65}), Sum{});
  EXPECT_EQ(sum_of({0x1.8p-64}).value(), 0x1p-64);
  EXPECT_EQ(sum_of({-0x1.8p-64}).value(), -0x1p-64);
  EXPECT_EQ(sum_of({0.0, -0.0, 5e-324, -1e-300}), Sum{});
}

TEST(FixedSum, CarriesAndBorrowsAcrossWords) {
  EXPECT_EQ(sum_of({0x1p-64, -0x1p-64}), Sum{});
  EXPECT_EQ(sum_of({1, -0x1p-64}).words, (std::array<std::uint64_t, 2>{~std::uint64_t{0}, 0}));
  EXPECT_EQ(sum_of({1, -0x1p-64, 0x1p-64}).words, (std::array<std::uint64_t, 2>{0, 1}));
  EXPECT_EQ(sum_of({-1, 0x1p-64}).value(), -1);  // -(1 - 2^-64), rounded to -1
  FixedSum<3, 80> wide;
  wide.add(0x1p100);
  wide.add(-0x1p-80);
  EXPECT_EQ(wide.words, (std::array<std::uint64_t, 3>{~std::uint64_t{0}, ~std::uint64_t{0},
                                                      (std::uint64_t{1} << 52U) - 1}));
  wide.add(0x1p-80);
  EXPECT_EQ(wide.value(), 0x1p100);
}

// The terms reach 2^62, so both code paths of add() are covered: below and above 2^30.
TEST(FixedSum, TermsAreTruncatedToMultiplesOfTheUnit) {
  __extension__ using Wide = __int128;
  std::mt19937_64 random(2);
  for (int i = 0; i < 100000; ++i) {
    const auto mantissa = static_cast<double>(static_cast<std::int64_t>(random()));
    const double x = std::ldexp(mantissa, -static_cast<int>(random() % 140));
    if (std::abs(x) >= 0x1p62) continue;
    const auto expected = static_cast<Wide>(std::ldexp(x, 64));
    const Sum sum = sum_of({x});
    ASSERT_EQ(sum.words[0], static_cast<std::uint64_t>(expected)) << x;
    ASSERT_EQ(sum.words[1], static_cast<std::uint64_t>(expected >> 64)) << x;
    FixedSum<3, 80> wide;
    wide.add(std::ldexp(x, -16));
    ASSERT_EQ(wide.words[0], sum.words[0]) << x;
    ASSERT_EQ(wide.words[1], sum.words[1]) << x;
    ASSERT_EQ(wide.words[2], expected < 0 ? ~std::uint64_t{0} : 0) << x;
  }
}

// 65536 equal terms of 24 bits must sum to exactly 65536 times their value.
TEST(FixedSum, EqualTermsAddUpExactly) {
  for (const float x : {0.1F, 3e-6F, 1e9F, 0.7F}) {
    Sum sum;
    for (int i = 0; i < 65536; ++i) sum.add(x);
    EXPECT_EQ(sum.value(), 65536.0 * x);
  }
}

TEST(FixedSum, OrderAndGroupingHaveNoEffect) {
  std::mt19937 random(1);
  std::vector<double> terms;
  for (int i = 0; i < 1000; ++i) {
    const int exponent = static_cast<int>(random() % 80) - 40;
    const double mantissa = static_cast<double>(random()) - 0x1p31;
    terms.push_back(std::ldexp(mantissa, exponent - 32));
  }
  const Sum sum = sum_of(terms);
  for (int round = 0; round < 20; ++round) {
    std::shuffle(terms.begin(), terms.end(), random);
    Sum left, right;
    const auto cut = static_cast<std::size_t>(random() % 1000);
    for (std::size_t i = 0; i < terms.size(); ++i) (i < cut ? left : right).add(terms[i]);
    left += right;
    EXPECT_EQ(left, sum);
  }
  // The sum of doubles must depend on the order. Otherwise the test would prove nothing.
  double forth = 0, back = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    forth += terms[i];
    back += terms[terms.size() - 1 - i];
  }
  EXPECT_NE(forth, back);
}

}  // namespace
}  // namespace microtrace
