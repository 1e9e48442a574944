#pragma once
/// Estimates the noise of tiles.

#include <microtrace/sample_sums.hpp>

#include <vector>

namespace microtrace {

/// Returns for each tile, in order, the mean over the tile's pixels of s / ((L + M) / 2). L is the
/// pixel's displayed luminance, s the estimated standard error of L, and M the mean of L over the
/// window. The result is 0 if all pixels are black. If the picture has alpha, a pixel's error is at
/// least the same of a white background that it lets through. Sums have a fixed order.
[[nodiscard]] std::vector<double> tile_errors(const SampleSums& sums, bool has_alpha);

/// Returns true for each tile that has converged: its error and the errors of its eight neighbors
/// are at most `target`. The neighbors count because a tile may not have sampled a bright spot yet.
[[nodiscard]] std::vector<bool> good_tiles(const std::vector<double>& errors,
                                           const PixelRect& window, double target);

}  // namespace microtrace
