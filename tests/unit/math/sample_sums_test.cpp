#include <microtrace/sample_sums.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr Vec3 kBlack{0};

TEST(PixelSum, EqualSamplesGiveTheirColor) {
  const Vec3 color(0.1F, 1e-5F, 12345.678F);
  PixelSum sum;
  for (int i = 0; i < 65536; ++i) EXPECT_TRUE(sum.add(color, 0.3F, kBlack));
  EXPECT_EQ(sum.mean_color(), color);
  EXPECT_EQ(sum.mean_alpha(), 0.3F);
  EXPECT_LT(sum.variance(kBlack), 1e-12 * sum.mean_luminance(kBlack));
}

TEST(PixelSum, NoSamplesAreBlackAndTransparent) {
  const PixelSum sum;
  EXPECT_EQ(sum.mean_color(), kBlack);
  EXPECT_EQ(sum.mean_alpha(), 0);
  EXPECT_EQ(sum.variance(kBlack), 0);
}

// If a fraction p of n values is v and the rest is 0, the estimated variance of their mean is v^2 p
// (1 - p) / (n - 1).
TEST(PixelSum, VarianceIsTheVarianceOfTheMean) {
  for (const float v : {1e-6F, 1.0F, 1e9F}) {
    PixelSum sum;
    for (int i = 0; i < 100; ++i) (void)sum.add(Vec3(i % 4 == 0 ? v : 0), 1, kBlack);
    const double expected = double{v} * v * 0.25 * 0.75 / 99;
    EXPECT_NEAR(sum.variance(kBlack) / expected, 1, 1e-6) << v;
  }
}

TEST(PixelSum, LuminanceIncludesTheBackground) {
  const Vec3 background(2, 4, 8);
  PixelSum sum;
  (void)sum.add(Vec3(1), 1, background);
  (void)sum.add(Vec3(0), 0, background);
  const double behind = 0.2126 * 2 + 0.7152 * 4 + 0.0722 * 8;
  EXPECT_NEAR(sum.mean_luminance(background), (1 + behind) / 2, 1e-12);
  const double deviation = (behind - 1) / 2;
  EXPECT_NEAR(sum.variance(background), deviation * deviation, 1e-10);
}

TEST(PixelSum, NanIsBlackAndInfinityIsClamped) {
  PixelSum sum;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(sum.add(Vec3(1, nan, 1), 0, kBlack));
  EXPECT_FALSE(sum.add(Vec3(1), nan, kBlack));
  EXPECT_TRUE(sum.add(Vec3(3, 6, 9), 1, kBlack));
  EXPECT_EQ(sum.mean_color(), Vec3(1, 2, 3));
  EXPECT_EQ(sum.mean_alpha(), 1);
  PixelSum bright;
  const float infinity = std::numeric_limits<float>::infinity();
  for (int i = 0; i < 65536; ++i) EXPECT_TRUE(bright.add(Vec3(infinity, -infinity, 0), 1, kBlack));
  EXPECT_EQ(bright.mean_color(), Vec3(0x1p46F, -0x1p46F, 0));
}

SampleSums sums_with(const std::vector<SampleRange>& ranges) {
  SampleSums sums({.width = 1, .height = 1}, {0, 0, 1, 1}, kBlack);
  for (const SampleRange& range : ranges) sums.note(range);
  return sums;
}

TEST(SampleSums, RangesJoinInOrder) {
  const SampleSums sums = sums_with({{8, 10}, {0, 4}, {10, 11}, {6, 8}});
  EXPECT_EQ(sums.ranges(), (std::vector<SampleRange>{{0, 4}, {6, 11}}));
  EXPECT_EQ(sums.count(), 9U);
}

TEST(SampleSums, MissingIsTheComplement) {
  using Ranges = std::vector<SampleRange>;
  const SampleSums sums = sums_with({{2, 4}, {6, 8}});
  EXPECT_EQ(sums.missing({0, 10}), (Ranges{{0, 2}, {4, 6}, {8, 10}}));
  EXPECT_EQ(sums.missing({2, 4}), Ranges{});
  EXPECT_EQ(sums.missing({3, 7}), (Ranges{{4, 6}}));
  EXPECT_EQ(sums.missing({9, 12}), (Ranges{{9, 12}}));
  EXPECT_EQ(sums.missing({0, 1}), (Ranges{{0, 1}}));
  EXPECT_TRUE(sums.overlaps({3, 5}));
  EXPECT_FALSE(sums.overlaps({4, 6}));
  EXPECT_FALSE(sums.overlaps({8, 100}));
}

}  // namespace
}  // namespace microtrace
