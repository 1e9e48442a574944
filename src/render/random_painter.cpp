#include "render/random_painter.hpp"

#include "render/ray_batch.hpp"
#include "render/sampling/dimensions.hpp"
#include "render/sampling/sobol.hpp"
#include "render/tiles.hpp"

#include <array>

namespace microtrace {

RandomPainter::RandomPainter(const World& world, const Integrator& integrator,
                             const RenderOptions& options, const Vec3& background)
    : world_(world),
      integrator_(integrator),
      ray_(world.camera, world.scene),
      filter_(options.filter),
      background_(background) {}

void RandomPainter::add(const PixelRect& tile, const SampleRange& range,
                        std::span<PixelSum> sums) const {
  RayBatch<kRandomBatch> batch;
  std::uint64_t invalid = 0;
  const auto trace = [&] {
    batch.trace(integrator_, world_, [&](std::size_t pixel, const Sample& sample) {
      if (!sums[pixel].add(sample.color, sample.alpha, background_)) ++invalid;
    });
  };
  std::array<std::uint32_t, std::size_t{kTileEdge} * kTileEdge> keys;
  std::size_t pixels = 0;
  for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
    for (std::uint32_t x = tile.x0; x < tile.x1; ++x)
      keys[pixels++] = sampling::pixel_key(world_.seed, x, y);
  }
  // Sample by sample, so that the rays of neighbouring pixels make bundles.
  for (std::uint32_t k = range.first; k < range.last; ++k) {
    std::size_t pixel = 0;
    for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
      for (std::uint32_t x = tile.x0; x < tile.x1; ++x, ++pixel) {
        if (batch.is_full()) trace();
        const SampleId id{.x = x, .y = y, .index = k, .key = keys[pixel]};
        const Vec2 uv = sampling::Sobol(id.key, id.index).pair(sampling::kPixelPair);
        const PixelOffset offset = filter_(uv.x, uv.y);
        batch.add(pixel, id, [&] { return ray_(x + offset.x, y + offset.y); });
      }
    }
  }
  trace();
  samples_ += std::uint64_t{tile.size().width} * tile.size().height * range.size();
  invalid_ += invalid;
}

}  // namespace microtrace
