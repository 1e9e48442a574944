#include "render/samples/random_painter.hpp"

#include "render/film/tiles.hpp"
#include "render/lanes/dispatch.hpp"
#include "render/samples/pixel_adder.hpp"
#include "render/sampling/dimensions.hpp"
#include "render/sampling/sobol.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

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

/// The pixels of a tile in Morton order, in which consecutive pixels are close to each other.
class RandomPainter::TilePixels {
 public:
  TilePixels(const PixelRect& tile, std::uint32_t seed, const sampling::TimeSlice& slice) {
    const auto [width, height] = tile.size();
    for (std::uint32_t code = 0; code < kTilePixels; ++code) {
      const std::uint32_t x = even_bits(code), y = even_bits(code >> 1U);
      if (x >= width || y >= height) continue;
      places_[count_] = std::size_t{y} * width + x;
      Pixel& pixel = pixels_[count_++];
      pixel = {.x = tile.x0 + x, .y = tile.y0 + y};
      pixel.key = sampling::pixel_key(seed, pixel.x, pixel.y);
      pixel.first_sample = sampling::first_sample_in(slice, pixel.key);
    }
  }

  struct Pixel {
    std::uint32_t x = 0, y = 0;
    std::uint32_t key = 0;
    std::uint32_t first_sample = 0;  ///< in the slice of time
  };
  [[nodiscard]] std::span<const Pixel> pixels() const { return std::span(pixels_).first(count_); }
  /// The pixels' indices in the order of rows.
  [[nodiscard]] std::span<const std::size_t> places() const {
    return std::span(places_).first(count_);
  }

 private:
  /// Bits 0, 2 and 4 as a number.
  static std::uint32_t even_bits(std::uint32_t code) {
    return (code & 1U) | (code >> 1U & 2U) | (code >> 2U & 4U);
  }

  std::array<Pixel, kTilePixels> pixels_{};
  std::array<std::size_t, kTilePixels> places_{};
  std::size_t count_ = 0;
};

void RandomPainter::add(const PixelRect& tile, const SampleRange& range,
                        std::span<PixelSum> sums) const {
  const TilePixels all(tile, world_.seed, slice_);
  Batch batch(integrator_, has_alpha_);
  PixelAdder adder(kernels_, background_, sums, all.places());
  const std::optional<Sample> common = common_sample(tile);
  const auto trace = [&] {
    if (common) {
      adder.add(batch.fill(*common));
    } else {
      make_rays(batch);
      adder.add(batch.trace(world_));
    }
  };
  // Consecutive rays are up to 16 samples of one pixel, then of its neighbor, so that they form
  // narrow packets. Each pixel has one sample in the slice among `slice_.count` samples.
  constexpr std::uint32_t kTogether = 16;
  const std::uint32_t step = slice_.count;
  for (std::uint32_t k = range.first - range.first % step; k < range.last; k += kTogether * step) {
    for (std::size_t i = 0; i < all.pixels().size(); ++i) {
      const TilePixels::Pixel& pixel = all.pixels()[i];
      const std::uint32_t first = k + pixel.first_sample;
      const std::uint32_t last = std::min(range.last, first + kTogether * step);
      for (std::uint32_t index = first; index < last; index += step) {
        if (index < range.first) continue;
        if (batch.is_full()) trace();
        batch.add(i, {.x = pixel.x, .y = pixel.y, .index = index, .key = pixel.key});
      }
    }
  }
  trace();
  samples_ += adder.samples();
  invalid_ += adder.invalid();
}

std::optional<Sample> RandomPainter::common_sample(const PixelRect& tile) const {
  if (ray_.has_lens()) return std::nullopt;
  const std::optional<Frustum> frustum = ray_.frustum(tile, filter_(0, 0), filter_(1, 1));
  return frustum ? integrator_.common_sample(world_, *frustum) : std::nullopt;
}

void RandomPainter::make_rays(Batch& batch) const {
  constexpr std::size_t kLanes = kShadingLanes;
  std::array<std::uint32_t, kLanes> keys{}, indices{};
  std::array<double, kLanes> x, y;
  std::array<float, kLanes> lens_u, lens_v;
  for (std::size_t first = 0; first < batch.ids().size(); first += kLanes) {
    const std::size_t size = std::min(kLanes, batch.ids().size() - first);
    const std::span<const SampleId> ids = batch.ids().subspan(first, size);
    for (std::size_t i = 0; i < size; ++i) {
      keys[i] = ids[i].key;
      indices[i] = ids[i].index;
    }
    kernels_.sample_positions(keys.data(), indices.data(), sampling::kPixelPair, filter_.table(),
                              x.data(), y.data());
    for (std::size_t i = 0; i < size; ++i) {
      x[i] += ids[i].x;
      y[i] += ids[i].y;
    }
    const std::span<Ray> rays = batch.rays().subspan(first, size);
    if (!ray_.has_lens()) {
      ray_.through(std::span(x).first(size), std::span(y).first(size), rays);
      continue;
    }
    kernels_.random_pairs(keys.data(), indices.data(), sampling::kLensPair, lens_u.data(),
                          lens_v.data());
    for (std::size_t i = 0; i < size; ++i)
      rays[i] = ray_.sample(x[i], y[i], {lens_u[i], lens_v[i]});
  }
}

}  // namespace microtrace
