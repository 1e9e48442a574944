#include "render/tile_errors.hpp"

#include "render/tiles.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace microtrace {

std::vector<double> tile_errors(const SampleSums& sums) {
  double total = 0;
  for (const PixelSum& pixel : sums.pixels)
    total += std::max(pixel.mean_luminance(sums.background), 0.0);
  const double mean = total / static_cast<double>(sums.pixels.size());
  std::vector<double> errors(tile_count(sums.window));
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const PixelRect tile = tile_at(i, sums.window);
    double sum = 0;
    for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
      for (std::uint32_t x = tile.x0; x < tile.x1; ++x) {
        const PixelSum& pixel = sums.at(x, y);
        const double light = (std::max(pixel.mean_luminance(sums.background), 0.0) + mean) / 2;
        if (light > 0) sum += std::sqrt(pixel.variance(sums.background)) / light;
      }
    }
    errors[i] = sum / (double{1} * tile.size().width * tile.size().height);
  }
  return errors;
}

std::vector<bool> good_tiles(const std::vector<double>& errors, const PixelRect& window,
                             double target) {
  const std::size_t columns = tile_columns(window), rows = errors.size() / columns;
  std::vector<bool> good(errors.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const std::size_t column = i % columns, row = i / columns;
    double worst = 0;
    for (std::size_t y = row - std::min<std::size_t>(row, 1); y <= std::min(row + 1, rows - 1);
         ++y) {
      for (std::size_t x = column - std::min<std::size_t>(column, 1);
           x <= std::min(column + 1, columns - 1); ++x)
        worst = std::max(worst, errors[y * columns + x]);
    }
    good[i] = worst <= target;
  }
  return good;
}

}  // namespace microtrace
