#include "render/samples/random_painter.hpp"

#include "render/kernels/dispatch.hpp"
#include "render/ray_batch.hpp"
#include "render/samples/pixel_adder.hpp"
#include "render/sampling/dimensions.hpp"
#include "render/sampling/sobol.hpp"
#include "render/tiles.hpp"

#include <algorithm>
#include <array>

namespace microtrace {

RandomPainter::RandomPainter(const World& world, const Integrator& integrator,
                             const RenderOptions& options, const Vec3& background,
                             const sampling::TimeSlice& slice)
    : world_(world),
      integrator_(integrator),
      ray_(world.camera, world.scene),
      filter_(options.filter),
      background_(background),
      has_alpha_(options.transparent),
      slice_(slice),
      kernels_(kShadingKernels.best()) {}

void RandomPainter::add(const PixelRect& tile, const SampleRange& range,
                        std::span<PixelSum> sums) const {
  RayBatch<kRandomBatch> batch(integrator_, has_alpha_);
  PixelAdder adder(kernels_, background_, sums);
  struct Pixel {
    std::uint32_t x, y;
  };
  std::array<Pixel, kTilePixels> pixels;
  std::array<std::uint32_t, kTilePixels> keys{}, first_samples{};
  std::size_t count = 0;
  for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
    for (std::uint32_t x = tile.x0; x < tile.x1; ++x) {
      keys[count] = sampling::pixel_key(world_.seed, x, y);
      first_samples[count] = sampling::first_sample_in(slice_, keys[count]);
      pixels[count++] = {.x = x, .y = y};
    }
  }
  // Loops over samples first, so that the rays of neighboring pixels form packets. Each pixel has
  // one sample in the slice among `slice_.count` samples.
  static_assert(kTilePixels % kShadingLanes == 0);
  std::array<std::uint32_t, kShadingLanes> indices;
  std::array<double, kShadingLanes> u, v, x, y;
  std::array<float, kShadingLanes> lens_u, lens_v;
  for (std::uint32_t k = range.first - range.first % slice_.count; k < range.last;
       k += slice_.count) {
    for (std::size_t first = 0; first < count; first += kShadingLanes) {
      for (std::size_t i = 0; i < kShadingLanes; ++i) indices[i] = k + first_samples[first + i];
      kernels_.sample_positions(&keys[first], indices.data(), sampling::kPixelPair, filter_.table(),
                                u.data(), v.data());
      if (ray_.has_lens()) {
        kernels_.random_pairs(&keys[first], indices.data(), sampling::kLensPair, lens_u.data(),
                              lens_v.data());
      }
      if (batch.is_full(kShadingLanes)) adder.add(batch.trace(world_));
      const std::size_t size = std::min<std::size_t>(count - first, kShadingLanes);
      std::size_t rays = 0;
      for (std::size_t i = 0; i < size; ++i) {
        if (indices[i] < range.first || indices[i] >= range.last) continue;
        const Pixel pixel = pixels[first + i];
        x[rays] = pixel.x + u[i];
        y[rays] = pixel.y + v[i];
        lens_u[rays] = lens_u[i];
        lens_v[rays++] = lens_v[i];
        batch.add(first + i,
                  {.x = pixel.x, .y = pixel.y, .index = indices[i], .key = keys[first + i]});
      }
      const std::span<Ray> made = batch.last_rays(rays);
      if (!ray_.has_lens()) {
        ray_.through(std::span(x).first(rays), std::span(y).first(rays), made);
        continue;
      }
      for (std::size_t i = 0; i < rays; ++i)
        made[i] = ray_.sample(x[i], y[i], {lens_u[i], lens_v[i]});
    }
  }
  adder.add(batch.trace(world_));
  samples_ += adder.samples();
  invalid_ += adder.invalid();
}

}  // namespace microtrace
