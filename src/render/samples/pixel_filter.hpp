#pragma once
/// Samples positions around a pixel's center by the pixel filter, so that all samples have equal
/// weight.

#include "render/samples/sample_pattern.hpp"

#include <microtrace/render.hpp>

#include <array>
#include <cstddef>

namespace microtrace {

/// Samples positions with the pdf of a PixelFilter (M. Ernst, M. Stamminger and G. Greiner, Filter
/// importance sampling, 2006).
class FilterSampler {
 public:
  explicit FilterSampler(PixelFilter filter);

  /// Maps u, v in [0, 1] to a position in pixels, measured from the pixel's upper left corner.
  /// Equal areas map to equal parts of the filter's weight, and (1/2, 1/2) maps to the pixel's
  /// center.
  [[nodiscard]] PixelOffset operator()(double u, double v) const {
    if (filter_ == PixelFilter::box) return {.x = u, .y = v};
    return {.x = place(u), .y = place(v)};
  }

 private:
  [[nodiscard]] double place(double u) const;

  static constexpr std::size_t kSteps = 512;
  PixelFilter filter_;
  /// Entry i is the distance from the center, in pixels, that contains all but (1 - i / kSteps)^2
  /// of the weight. The square shortens the steps where the filter is low.
  std::array<double, kSteps + 1> reach_{};
};

}  // namespace microtrace
