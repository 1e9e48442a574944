#pragma once
/// Sample positions within a pixel.

#include <cstdint>
#include <vector>

namespace microtrace {

/// A point of the pixel's square, each coordinate in (0, 1).
struct PixelOffset {
  double x, y;
};

/// n points in n columns and n rows of equal width, with one point in the middle of each column and
/// each row. Rows follow van der Corput's sequence in base 2 (J. G. van der Corput,
/// Verteilungsfunktionen, 1935). A single point is the center.
[[nodiscard]] std::vector<PixelOffset> sample_pattern(std::uint32_t n);

}  // namespace microtrace
