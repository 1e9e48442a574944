#include "render/film/pixel_filter.hpp"

#include "support/pi.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// Returns the four-term Blackman-Harris window, 3 pixels wide and normalized, at t pixels from its
/// center.
double density(double t) {
  if (std::abs(t) > 1.5) return 0;
  const double x = 2 * kPi * t / 3;
  return (0.35875 + 0.48829 * std::cos(x) + 0.14128 * std::cos(2 * x) + 0.01168 * std::cos(3 * x)) /
         (3 * 0.35875);
}

TEST(PixelFilter, BoxKeepsPositions) {
  const FilterSampler box(PixelFilter::box);
  const PixelOffset place = box(0.125, 0.75);
  EXPECT_EQ(place.x, 0.125);
  EXPECT_EQ(place.y, 0.75);
}

TEST(PixelFilter, BlackmanHarrisMapsToItsWholeWidth) {
  const FilterSampler filter(PixelFilter::blackman_harris);
  EXPECT_EQ(filter(0, 1).x, -1);
  EXPECT_EQ(filter(0, 1).y, 2);
  EXPECT_EQ(filter(0.5, 0.5).x, 0.5);
  for (int i = 1; i <= 1000; ++i) {
    EXPECT_GT(filter(i / 1000.0, 0).x, filter((i - 1) / 1000.0, 0).x) << i;
  }
}

// Integrates the window by Simpson's rule: each of n equal intervals of u must contain 1/n of the
// weight.
TEST(PixelFilter, EqualIntervalsHaveEqualWeight) {
  const FilterSampler filter(PixelFilter::blackman_harris);
  constexpr int n = 64;
  for (int i = 0; i < n; ++i) {
    const double from = filter(i / double{n}, 0).x - 0.5;
    const double to = filter((i + 1) / double{n}, 0).x - 0.5;
    constexpr int kParts = 200;
    double weight = 0;
    for (int k = 0; k < kParts; ++k) {
      const double h = (to - from) / kParts, a = from + k * h;
      weight += h / 6 * (density(a) + 4 * density(a + h / 2) + density(a + h));
    }
    EXPECT_NEAR(weight, 1.0 / n, 1e-6) << i;
  }
}

// The closed form of the window's second moment is 1/12 + (-a1 + a2/4 - a3/9) / (2 pi^2 a0) times
// the square of its width.
TEST(PixelFilter, VarianceEqualsTheWindows) {
  const FilterSampler filter(PixelFilter::blackman_harris);
  constexpr int n = 100000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double d = filter(0, (i + 0.5) / n).y - 0.5;
    sum += d * d;
  }
  const double exact =
      9 * (1.0 / 12 + (-0.48829 + 0.14128 / 4 - 0.01168 / 9) / (2 * kPi * kPi * 0.35875));
  EXPECT_NEAR(sum / n, exact, 1e-5);
  EXPECT_NEAR(std::sqrt(exact), 0.416, 0.001);
}

}  // namespace
}  // namespace microtrace
