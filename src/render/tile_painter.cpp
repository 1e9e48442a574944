#include "render/tile_painter.hpp"

#include "render/film/film_pixel.hpp"
#include "render/film/ray_batch.hpp"
#include "render/film/tiles.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace microtrace {
namespace {

static_assert(kTilePixels <= kRegularBatch);

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
      least_(pattern_[0]),
      greatest_(pattern_[0]),
      background_(integrator.is_data() ? Vec3(0)
                                       : options.background.value_or(world.scene.background)),
      block_width_(kTileEdge),
      block_height_(kTileEdge) {
  for (const PixelOffset& place : pattern_) {
    least_ = {.x = std::min(least_.x, place.x), .y = std::min(least_.y, place.y)};
    greatest_ = {.x = std::max(greatest_.x, place.x), .y = std::max(greatest_.y, place.y)};
  }
  // The rays of a batch should be coherent, so batches consist of few pixels if pixels have many
  // samples.
  while (block_width_ * block_height_ > 1 &&
         std::size_t{block_width_} * block_height_ * pattern_.size() > kRegularBatch) {
    (block_height_ == block_width_ ? block_height_ : block_width_) /= 2;
  }
}

std::optional<Sample> TilePainter::common_sample(const PixelRect& part) const {
  const std::optional<Frustum> frustum = ray_.frustum(part, least_, greatest_);
  return frustum ? integrator_.common_sample(world_, *frustum) : std::nullopt;
}

void TilePainter::set(std::uint32_t x, std::uint32_t y, const Sample& sample) const {
  set_pixel(film_, x - window_.x0, y - window_.y0, sample.color, sample.alpha, background_);
}

void TilePainter::paint_block(const PixelRect& block) const {
  RayBatch<kRegularBatch> batch(integrator_, film_.has_alpha());
  std::array<double, kRegularBatch> film_x, film_y;  // of the batch's samples
  std::array<Sum, kTilePixels> sums;
  const bool is_single = pattern_.size() == 1;
  if (!is_single) sums.fill({});
  const auto trace = [&] {
    const std::span<Ray> rays = batch.rays();
    ray_.through(std::span(film_x).first(rays.size()), std::span(film_y).first(rays.size()), rays);
    const auto [pixels, samples] = batch.trace(world_);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (is_single)
        set(block.x0 + static_cast<std::uint32_t>(pixels[i] % kTileEdge),
            block.y0 + static_cast<std::uint32_t>(pixels[i] / kTileEdge), samples[i]);
      else
        sums[pixels[i]].add(samples[i]);
    }
  };
  const auto for_each_pixel = [&](const auto& visit) {
    for (std::uint32_t y = block.y0; y < block.y1; ++y)
      for (std::uint32_t x = block.x0; x < block.x1; ++x)
        visit(x, y, std::size_t{y - block.y0} * kTileEdge + (x - block.x0));
  };
  for_each_pixel([&](std::uint32_t x, std::uint32_t y, std::size_t pixel) {
    for (std::uint32_t k = 0; k < pattern_.size(); ++k) {
      if (batch.is_full()) trace();
      film_x[batch.rays().size()] = x + pattern_[k].x;
      film_y[batch.rays().size()] = y + pattern_[k].y;
      batch.add(pixel, {.x = x, .y = y, .index = k});
    }
  });
  trace();
  if (is_single) return;
  for_each_pixel([&](std::uint32_t x, std::uint32_t y, std::size_t pixel) {
    set(x, y, sums[pixel].over(static_cast<double>(pattern_.size())));
  });
}

bool TilePainter::fill(const PixelRect& part) const {
  const std::optional<Sample> sample = common_sample(part);
  if (!sample) return false;
  for (std::uint32_t y = part.y0; y < part.y1; ++y)
    set_pixels(film_, part.x0 - window_.x0, y - window_.y0, part.x1 - part.x0, sample->color,
               sample->alpha, background_);
  return true;
}

void TilePainter::trace(const PixelRect& tile) const {
  for (std::uint32_t y = tile.y0; y < tile.y1; y += block_height_) {
    for (std::uint32_t x = tile.x0; x < tile.x1; x += block_width_) {
      paint_block({.x0 = x,
                   .y0 = y,
                   .x1 = std::min(x + block_width_, tile.x1),
                   .y1 = std::min(y + block_height_, tile.y1)});
    }
  }
}

void TilePainter::paint(const PixelRect& part, const std::function<void()>& poll) const {
  if (fill(part)) return;
  const std::size_t count = tile_count(part);
  for (std::size_t i = 0; i < count; ++i) {
    const PixelRect tile = tile_at(i, part);
    if (count > 1 && fill(tile)) continue;
    trace(tile);
    if (pattern_.size() > 1) poll();
  }
}

}  // namespace microtrace
