#pragma once
/// Input and output of the kernels for pixels. Contains only plain data; see shading_kernels.hpp.

#include <cstdint>

namespace microtrace {

/// The distances from a pixel's center within which a filter has given parts of its weight.
struct FilterTable {
  static constexpr int kSteps = 512;
  /// Entry i is the distance, in pixels, that contains all but (1 - i / kSteps)^2 of the weight.
  /// The square shortens the steps where the filter is low.
  double reach[kSteps + 1];
};

/// The sums of at most 1024 samples for each pixel of a tile, as integers. A term x is the sum of
/// whole 2^-32 and a nonnegative or nonpositive part in the unit of the PixelSum's member.
struct alignas(64) TermSums {
  static constexpr int kPixels = 64;
  static constexpr double kLimit = 0x1p20;  ///< terms are smaller
  enum Term { red, green, blue, alpha, square, kTerms };

  std::int64_t whole[kTerms][kPixels], part[kTerms][kPixels];
  std::uint32_t count[kPixels];  ///< number of samples
};

struct SumSetup {
  double background[3];                 ///< under the samples, for the displayed luminance
  double most;                          ///< maximum of a color
  double part_scale[TermSums::kTerms];  ///< 2^-32 in units of the parts
};

}  // namespace microtrace
