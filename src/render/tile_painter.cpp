#include "render/tile_painter.hpp"

#include "render/sampling/dimensions.hpp"
#include "render/sampling/sobol.hpp"
#include "render/tiles.hpp"

#include <algorithm>
#include <array>
#include <new>
#include <span>
#include <vector>

namespace microtrace {
namespace {

constexpr std::size_t kTilePixels = std::size_t{kTileEdge} * kTileEdge;
static_assert(kTilePixels <= kMaxBatch);

/// Float64, so that equal samples give their own colour: a sum of 65536 equal float32 is exact.
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

/// Rays on their way to the integrator, and the pixel of the block that each belongs to.
template <std::size_t Size>
class Batch {
 public:
  [[nodiscard]] bool is_full() const { return count_ == Size; }

  /// make_ray() makes the ray in its place: copying what was just written in parts is slow.
  template <class MakeRay>
  void add(std::size_t pixel, const SampleId& id, const MakeRay& make_ray) {
    ::new (&rays_[count_]) Ray(make_ray());
    ids_[count_] = id;
    pixels_[count_++] = pixel;
  }

  /// f(pixel, sample) in the order of the rays; leaves the batch empty.
  template <class F>
  void trace(const Integrator& integrator, const World& world, F&& f) {
    integrator.trace(world, std::span(rays_).first(count_), std::span(ids_).first(count_),
                     std::span(samples_).first(count_));
    for (std::size_t i = 0; i < count_; ++i) f(pixels_[i], samples_[i]);
    count_ = 0;
  }

 private:
  std::size_t count_ = 0;
  std::array<Ray, Size> rays_;
  std::array<SampleId, Size> ids_;
  std::array<std::size_t, Size> pixels_;
  std::array<Sample, Size> samples_;
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
      samples_(options.samples),
      filter_(options.filter),
      pattern_(filtered_pattern(options.samples, filter_)),
      background_(integrator.is_data() ? Vec3(0) : world.scene.background),
      block_width_(kTileEdge),
      block_height_(kTileEdge) {
  // The rays of a batch should go nearly the same way, so few pixels make one where each has many
  // samples.
  while (block_width_ * block_height_ > 1 &&
         std::size_t{block_width_} * block_height_ * pattern_.size() > kMaxBatch) {
    (block_height_ == block_width_ ? block_height_ : block_width_) /= 2;
  }
}

void TilePainter::set(std::uint32_t x, std::uint32_t y, const Sample& sample) const {
  x -= window_.x0;
  y -= window_.y0;
  if (film_.has_alpha()) {
    film_.at(x, y) = sample.color;
    film_.alpha_at(x, y) = sample.alpha;
  } else {
    film_.at(x, y) = sample.color + (1 - sample.alpha) * background_;
  }
}

void TilePainter::paint_block(const PixelRect& block) const {
  const std::uint32_t width = block.size().width;
  const auto set_pixel = [&](std::size_t pixel, const Sample& sample) {
    const auto index = static_cast<std::uint32_t>(pixel);
    set(block.x0 + index % width, block.y0 + index / width, sample);
  };
  Batch<kMaxBatch> batch;
  const auto gather = [&](auto&& before_each) {
    std::size_t pixel = 0;
    for (std::uint32_t y = block.y0; y < block.y1; ++y) {
      for (std::uint32_t x = block.x0; x < block.x1; ++x, ++pixel) {
        for (std::uint32_t k = 0; k < pattern_.size(); ++k) {
          before_each();
          batch.add(pixel, {.x = x, .y = y, .index = k},
                    [&] { return ray_(x + pattern_[k].x, y + pattern_[k].y); });
        }
      }
    }
    return pixel;
  };
  if (pattern_.size() == 1) {
    gather([] {});
    batch.trace(integrator_, world_, set_pixel);
    return;
  }
  std::array<Sum, kTilePixels> sums{};
  const auto add = [&](std::size_t pixel, const Sample& sample) { sums[pixel].add(sample); };
  const std::size_t pixels = gather([&] {
    if (batch.is_full()) batch.trace(integrator_, world_, add);
  });
  batch.trace(integrator_, world_, add);
  for (std::size_t p = 0; p < pixels; ++p) {
    set_pixel(p, sums[p].over(static_cast<double>(pattern_.size())));
  }
}

void TilePainter::paint_at_random(const PixelRect& tile) const {
  const std::uint32_t width = tile.size().width;
  Batch<kRandomBatch> batch;
  std::array<Sum, kTilePixels> sums{};
  const auto trace = [&] {
    batch.trace(integrator_, world_,
                [&](std::size_t pixel, const Sample& sample) { sums[pixel].add(sample); });
  };
  // Sample by sample, so that the rays of neighbouring pixels make bundles.
  for (std::uint32_t k = 0; k < samples_; ++k) {
    for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
      for (std::uint32_t x = tile.x0; x < tile.x1; ++x) {
        if (batch.is_full()) trace();
        const SampleId id{.x = x, .y = y, .index = k};
        const Vec2 uv = sampling::Sobol(world_.seed, id).pair(sampling::kPixelPair);
        const PixelOffset offset = filter_(uv.x, uv.y);
        batch.add(std::size_t{y - tile.y0} * width + (x - tile.x0), id,
                  [&] { return ray_(x + offset.x, y + offset.y); });
      }
    }
  }
  trace();
  for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
    for (std::uint32_t x = tile.x0; x < tile.x1; ++x) {
      set(x, y, sums[std::size_t{y - tile.y0} * width + (x - tile.x0)].over(samples_));
    }
  }
}

void TilePainter::paint(const PixelRect& tile) const {
  if (integrator_.is_random()) return paint_at_random(tile);
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
