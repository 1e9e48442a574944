#pragma once
/// Where the samples of a pixel lie.

#include <cstdint>
#include <vector>

namespace microtrace {

/// A point of a pixel's square, each coordinate in (0, 1).
struct PixelOffset {
  double x, y;
};

/// n points in n columns and n rows of equal width, each column and each row with one of them in
/// its middle; the rows are taken in the order of van der Corput's sequence in base 2 (J. G. van
/// der Corput, Verteilungsfunktionen, 1935). One point is the centre.
[[nodiscard]] std::vector<PixelOffset> sample_pattern(std::uint32_t n);

}  // namespace microtrace
