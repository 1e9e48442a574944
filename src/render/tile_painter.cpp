#include "render/tile_painter.hpp"

#include "render/film_pixel.hpp"
#include "render/ray_batch.hpp"
#include "render/tiles.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace microtrace {
namespace {

static_assert(kTilePixels <= kMaxBatch);

/// Sums are float64, so that the mean of equal samples is exactly their color: a sum of 65536 equal
/// float32 numbers is exact.
struct Sum {
  DVec3 color{0};
  double alpha = 0;

  void add(const Sample& sample) {
    color += DVec3(sample.color);
    alpha += sample.alpha;
  }
  [[nodiscard]] Sample over(double count) const {
    return {.color = Vec3(color / count), .alpha = static_cast<float>(alpha / count)};
  }
};

std::vector<PixelOffset> filtered_pattern(std::uint32_t samples, const FilterSampler& filter) {
  std::vector<PixelOffset> pattern = sample_pattern(samples);
  for (PixelOffset& place : pattern) place = filter(place.x, place.y);
  return pattern;
}

}  // namespace

TilePainter::TilePainter(const World& world, const Integrator& integrator,
                         const RenderOptions& options, const PixelRect& window, Film& film)
    : world_(world),
      integrator_(integrator),
      ray_(world.camera, world.scene),
      window_(window),
      film_(film),
      pattern_(filtered_pattern(options.samples, FilterSampler(options.filter))),
      background_(integrator.is_data() ? Vec3(0)
                                       : options.background.value_or(world.scene.background)),
      block_width_(kTileEdge),
      block_height_(kTileEdge) {
  // The rays of a batch should be coherent, so batches consist of few pixels if pixels have many
  // samples.
  while (block_width_ * block_height_ > 1 &&
         std::size_t{block_width_} * block_height_ * pattern_.size() > kMaxBatch) {
    (block_height_ == block_width_ ? block_height_ : block_width_) /= 2;
  }
}

void TilePainter::paint_block(const PixelRect& block) const {
  const std::uint32_t width = block.size().width;
  const auto set = [&](std::size_t pixel, const Sample& sample) {
    const auto index = static_cast<std::uint32_t>(pixel);
    set_pixel(film_, block.x0 - window_.x0 + index % width, block.y0 - window_.y0 + index / width,
              sample.color, sample.alpha, background_);
  };
  RayBatch<kMaxBatch> batch(integrator_, film_.has_alpha());
  std::array<Sum, kTilePixels> sums{};
  const bool is_single = pattern_.size() == 1;
  const auto trace = [&] {
    const auto [pixels, samples] = batch.trace(world_);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (is_single)
        set(pixels[i], samples[i]);
      else
        sums[pixels[i]].add(samples[i]);
    }
  };
  std::size_t pixel = 0;
  for (std::uint32_t y = block.y0; y < block.y1; ++y) {
    for (std::uint32_t x = block.x0; x < block.x1; ++x, ++pixel) {
      for (std::uint32_t k = 0; k < pattern_.size(); ++k) {
        if (batch.is_full()) trace();
        batch.add(pixel, {.x = x, .y = y, .index = k});
        batch.rays().back() = ray_(x + pattern_[k].x, y + pattern_[k].y);
      }
    }
  }
  trace();
  if (is_single) return;
  for (std::size_t p = 0; p < pixel; ++p)
    set(p, sums[p].over(static_cast<double>(pattern_.size())));
}

void TilePainter::paint(const PixelRect& tile) const {
  for (std::uint32_t y = tile.y0; y < tile.y1; y += block_height_) {
    for (std::uint32_t x = tile.x0; x < tile.x1; x += block_width_) {
      paint_block({.x0 = x,
                   .y0 = y,
                   .x1 = std::min(x + block_width_, tile.x1),
                   .y1 = std::min(y + block_height_, tile.y1)});
    }
  }
}

}  // namespace microtrace
