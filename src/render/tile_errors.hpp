#pragma once
/// Estimated noise of tiles.

#include <microtrace/sample_sums.hpp>

#include <vector>

namespace microtrace {

/// For each tile, in order: the mean over its pixels of s / ((L + M) / 2), where s is the estimated
/// standard error of the pixel's displayed luminance, L this luminance and M its mean over the
/// window. 0 if all pixels are black. Summed in a fixed order.
[[nodiscard]] std::vector<double> tile_errors(const SampleSums& sums);

/// For each tile: true if it has converged, because its error and those of its eight neighbors are
/// at most `target`. The condition on neighbors continues tiles that have not sampled a bright spot
/// yet.
[[nodiscard]] std::vector<bool> good_tiles(const std::vector<double>& errors,
                                           const PixelRect& window, double target);

}  // namespace microtrace
