#pragma once
/// Sample positions within a pixel.

#include <cstdint>
#include <vector>

namespace microtrace {

/// A point in the pixel's square. Both coordinates are in (0, 1).
struct PixelOffset {
  double x, y;
};

/// Divides the pixel into n columns and n rows of equal size, and returns n points. Each column and
/// each row contains one point at its middle. The order of rows follows van der Corput's sequence
/// in base 2 (J. G. van der Corput, Verteilungsfunktionen, 1935). A single point is the center.
[[nodiscard]] std::vector<PixelOffset> sample_pattern(std::uint32_t n);

}  // namespace microtrace
