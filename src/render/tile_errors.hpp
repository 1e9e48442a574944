#pragma once
/// How noisy the parts of a picture still are.

#include <microtrace/sample_sums.hpp>

#include <vector>

namespace microtrace {

/// For each tile, in the order of tiles: the mean over its pixels of s / ((L + M) / 2), where s is
/// the estimated standard error of the luminance that the pixel shows, L that luminance and M its
/// mean over the window. 0 where all is black. Summed in a fixed order.
[[nodiscard]] std::vector<double> tile_errors(const SampleSums& sums);

/// For each tile whether it needs no more samples: it and its eight neighbours are no noisier than
/// `target`, so that a tile that has not met a bright spot yet is asked on while one beside it has.
[[nodiscard]] std::vector<bool> good_tiles(const std::vector<double>& errors,
                                           const PixelRect& window, double target);

}  // namespace microtrace
