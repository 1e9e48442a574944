#pragma once
/// Positions of samples around a pixel's center, such that all samples have the same weight.

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

  /// Maps u, v in [0, 1] to a position in pixels from the pixel's upper left corner: equal areas
  /// map to equal parts of the filter's weight, the middle to the center.
  [[nodiscard]] PixelOffset operator()(double u, double v) const {
    if (filter_ == PixelFilter::box) return {.x = u, .y = v};
    return {.x = place(u), .y = place(v)};
  }

 private:
  [[nodiscard]] double place(double u) const;

  static constexpr std::size_t kSteps = 512;
  PixelFilter filter_;
  /// The distance from the center, in pixels, that contains all but (1 - i / kSteps)^2 of the
  /// weight: steps are shorter where the filter is low.
  std::array<double, kSteps + 1> reach_{};
};

}  // namespace microtrace
