#pragma once
/// Samples positions around a pixel's center by the pixel filter, so that all samples have equal
/// weight.

#include "render/film/sample_pattern.hpp"
#include "render/lanes/film_lanes.hpp"

#include <microtrace/render.hpp>

#include <optional>

namespace microtrace {

/// Samples positions with the pdf of a PixelFilter (M. Ernst, M. Stamminger and G. Greiner, Filter
/// importance sampling, 2006).
class FilterSampler {
 public:
  explicit FilterSampler(PixelFilter filter);

  /// Maps u, v in [0, 1] to a position in pixels, measured from the pixel's upper left corner.
  /// Equal areas map to equal parts of the filter's weight, and (1/2, 1/2) maps to the pixel's
  /// center.
  [[nodiscard]] PixelOffset operator()(double u, double v) const;

  /// The table for kernels; null for the box filter.
  [[nodiscard]] const FilterTable* table() const { return table_ ? &*table_ : nullptr; }

 private:
  std::optional<FilterTable> table_{};
};

}  // namespace microtrace
