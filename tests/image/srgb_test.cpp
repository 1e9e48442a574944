#include "scene/math/srgb.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

#include <gtest/gtest.h>

namespace microtrace::io {
namespace {

/// 255 times the transfer function of IEC 61966-2-1, with a 64-bit significand. The encoder's table
/// represents the inverse of this function.
long double transfer(float v) {
  const auto x = static_cast<long double>(v);
  const long double encoded =
      x <= 0.0031308L ? 12.92L * x : 1.055L * std::pow(x, 1 / 2.4L) - 0.055L;
  return 255 * encoded;
}

TEST(Srgb, EachThresholdIsTheLeastFloatThatRoundsUp) {
  for (std::size_t k = 0; k < 255; ++k) {
    const float threshold = kSrgbThresholds[k];
    const float below = std::nextafter(threshold, 0.0F);
    const long double half = static_cast<long double>(k) + 0.5L;
    // The error of transfer() is below 1e-16, so this margin proves that long double is precise
    // enough in every case.
    EXPECT_GT(transfer(threshold) - half, 1e-13L) << k;
    EXPECT_GT(half - transfer(below), 1e-13L) << k;
    EXPECT_EQ(encode_srgb(threshold), k + 1);
    EXPECT_EQ(encode_srgb(below), k);
  }
}

TEST(Srgb, RoundsToNearestEverywhere) {
  // Steps of 2^-18 reach every bin of the table. They start below black and end above white.
  for (int i = -1000; i <= (1 << 18) + 1000; ++i) {
    const float v = std::ldexp(static_cast<float>(i), -18);
    const long double wanted = v <= 0 ? 0 : v >= 1 ? 255 : std::round(transfer(v));
    ASSERT_EQ(encode_srgb(v), static_cast<int>(wanted)) << v;
  }
}

TEST(Srgb, EndsAndOddities) {
  using limits = std::numeric_limits<float>;
  EXPECT_EQ(encode_srgb(0.0F), 0);
  EXPECT_EQ(encode_srgb(-0.0F), 0);
  EXPECT_EQ(encode_srgb(1.0F), 255);
  EXPECT_EQ(encode_srgb(limits::denorm_min()), 0);
  EXPECT_EQ(encode_srgb(limits::infinity()), 255);
  EXPECT_EQ(encode_srgb(-limits::infinity()), 0);
  EXPECT_EQ(encode_srgb(limits::quiet_NaN()), 0);
  EXPECT_EQ(encode_srgb(0.5F), 188);
  EXPECT_EQ(encode_srgb(0.21404F), 127);
  EXPECT_EQ(encode_srgb(0.21405F), 128);
}

TEST(Srgb, IsAConstantExpression) {
  static_assert(encode_srgb(0.5F) == 188);
}

}  // namespace
}  // namespace microtrace::io
