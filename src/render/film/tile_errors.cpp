#include "render/film/tile_errors.hpp"

#include "render/film/tiles.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace microtrace {

namespace {

/// The luminance of pixels over a background, and the standard error of one.
struct Shown {
  double light, error;
};

Shown as_displayed(const PixelSum& pixel, const Vec3& background) {
  return {.light = std::max(pixel.mean_luminance(background), 0.0),
          .error = std::sqrt(pixel.variance(background))};
}

/// Over white, with the error of the part that is let through. Samples have an alpha of 0 or 1, or
/// vary less.
Shown over_white(const PixelSum& pixel) {
  const double through = std::clamp(1 - double{pixel.mean_alpha()}, 0.0, 1.0);
  const double variance =
      pixel.count < 2 ? 0 : through * (1 - through) / (double{1} * pixel.count - 1);
  return {.light = std::max(pixel.mean_luminance(Vec3(0)), 0.0) + through,
          .error = std::sqrt(variance)};
}

/// The mean luminance over the window.
template <class Show>
double mean_light(const SampleSums& sums, const Show& show) {
  double total = 0;
  for (const PixelSum& pixel : sums.pixels) total += show(pixel).light;
  return total / static_cast<double>(sums.pixels.size());
}

double relative_error(const Shown& shown, double mean) {
  const double light = (shown.light + mean) / 2;
  return light > 0 ? shown.error / light : 0;
}

}  // namespace

std::vector<double> tile_errors(const SampleSums& sums, bool has_alpha) {
  const auto displayed = [&](const PixelSum& pixel) {
    return as_displayed(pixel, sums.background);
  };
  const double mean = mean_light(sums, displayed);
  const double mean_over_white = has_alpha ? mean_light(sums, over_white) : 0;
  std::vector<double> errors(tile_count(sums.window));
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const PixelRect tile = tile_at(i, sums.window);
    double sum = 0;
    for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
      for (std::uint32_t x = tile.x0; x < tile.x1; ++x) {
        const PixelSum& pixel = sums.at(x, y);
        const double error = relative_error(displayed(pixel), mean);
        sum +=
            has_alpha ? std::max(error, relative_error(over_white(pixel), mean_over_white)) : error;
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
