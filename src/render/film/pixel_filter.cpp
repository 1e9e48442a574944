#include "render/film/pixel_filter.hpp"

#include "render/film/sample_positions.hpp"
#include "scene/math/trigonometry.hpp"

#include <numbers>

namespace microtrace {
namespace {

constexpr double kRadius = 1.5;  // pixels

/// The fraction of the weight of a Blackman-Harris window of width 1 within t of the window's
/// center. It increases from 0 at t = 0 to 1 at t = 1/2. The coefficients are those of the "4-term,
/// -92 dB" window of F. J. Harris, On the use of windows for harmonic analysis with the discrete
/// Fourier transform, 1978.
double weight_within(double t) {
  constexpr double kA0 = 0.35875, kA1 = 0.48829, kA2 = 0.14128, kA3 = 0.01168;
  constexpr double kPi = std::numbers::pi;
  const double waves = kA1 * sin_radians(2 * kPi * t) + kA2 / 2 * sin_radians(4 * kPi * t) +
                       kA3 / 3 * sin_radians(6 * kPi * t);
  return 2 * t + waves / (kPi * kA0);
}

/// The inverse of weight_within, which increases monotonically because the window is never
/// negative.
double reach_of(double weight) {
  double low = 0, high = 0.5;
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = (low + high) / 2;
    (weight_within(middle) < weight ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

FilterSampler::FilterSampler(PixelFilter filter) {
  if (filter == PixelFilter::box) return;
  constexpr int kSteps = FilterTable::kSteps;
  FilterTable& table = table_.emplace();
  table.reach[0] = 0;
  for (int i = 1; i < kSteps; ++i) {
    const double outside = 1 - static_cast<double>(i) / kSteps;
    table.reach[i] = 2 * kRadius * reach_of(1 - outside * outside);
  }
  table.reach[kSteps] = kRadius;
}

PixelOffset FilterSampler::operator()(double u, double v) const {
  if (!table_) return {.x = u, .y = v};
  return {.x = filtered_place<1>(*table_, u), .y = filtered_place<1>(*table_, v)};
}

}  // namespace microtrace
