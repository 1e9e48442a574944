#pragma once
/// Where samples lie around a pixel's centre, such that each weighs the same.

#include "render/sample_pattern.hpp"

#include <microtrace/render.hpp>

#include <array>
#include <cstddef>

namespace microtrace {

/// Draws places from the density of a PixelFilter (M. Ernst, M. Stamminger and G. Greiner, Filter
/// importance sampling, 2006).
class FilterSampler {
 public:
  explicit FilterSampler(PixelFilter filter);

  /// u, v in [0, 1] to a place in pixels from the pixel's upper left corner: equal areas go to
  /// equal parts of the filter's weight, the middle to the centre.
  [[nodiscard]] PixelOffset operator()(double u, double v) const {
    if (filter_ == PixelFilter::box) return {.x = u, .y = v};
    return {.x = place(u), .y = place(v)};
  }

 private:
  [[nodiscard]] double place(double u) const;

  static constexpr std::size_t kSteps = 512;
  PixelFilter filter_;
  /// How far from the centre, in pixels, all but (1 - i / kSteps)^2 of the weight reaches: steps
  /// grow shorter where the filter is low.
  std::array<double, kSteps + 1> reach_{};
};

}  // namespace microtrace
