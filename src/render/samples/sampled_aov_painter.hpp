#pragma once
/// Fills the film's channels that contain means over samples.

#include "render/aovs/lamp_pixels.hpp"
#include "render/film/camera_rays.hpp"
#include "render/film/pixel_filter.hpp"
#include "render/samples/random_painter.hpp"

#include <microtrace/film.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/path.hpp>
#include <microtrace/render.hpp>
#include <microtrace/sample_sums.hpp>
#include <microtrace/sampled_aov.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace microtrace {

/// Any number of threads may paint disjoint tiles and set different pixels.
class SampledAovPainter {
 public:
  /// Adds the channels requested by the options to the film. The film must have the pixels of
  /// `window`. `background` is black if the film has alpha. All other arguments must outlive this
  /// object.
  SampledAovPainter(const World& world, const RenderOptions& options, const Vec3& background,
                    const PixelRect& window, Film& film);

  /// Sets a pixel's values from its samples. `pixel` is an index in the film.
  void set(std::size_t pixel, const PixelSum& sum) const;

  /// Computes the denoising features and the emission of a tile of the window. The tile has at most
  /// kTileEdge pixels per side. The emission is the mean over the first `count` of these samples.
  void paint(const PixelRect& tile, std::span<const SampleRange> samples,
             std::uint32_t count) const;

 private:
  void paint_features(const PixelRect& tile) const;
  void paint_emission(const PixelRect& tile, std::span<const SampleRange> samples,
                      std::uint32_t count) const;
  /// Adds the samples with the numbers in `range` to the pixels of lamps_.
  void add_at_lamps(const PixelRect& tile, const SampleRange& range,
                    std::span<PixelSum> sums) const;
  void set_emission(SampledAov aov, const PixelRect& tile, std::span<const PixelSum> sums) const;
  /// The index in the film of pixel i of the tile.
  [[nodiscard]] std::size_t index_of(const PixelRect& tile, std::size_t i) const;
  /// A value of a channel of the film.
  [[nodiscard]] float& value(SampledAov aov, std::size_t channel, std::size_t pixel) const;
  [[nodiscard]] bool has(SampledAov aov) const {
    return first_[static_cast<std::size_t>(aov)] != kNone;
  }

  static constexpr std::size_t kNone = ~std::size_t{0};
  const World& world_;
  const RenderOptions& options_;
  CameraRays ray_;
  FilterSampler filter_;
  Vec3 background_;
  PathIntegrator light_;  ///< takes the same samples as the colors' integrator
  RandomPainter emission_;
  /// Empty if no channel needs more samples there.
  std::optional<LampPixels> lamps_;
  const PixelRect& window_;
  Film& film_;
  std::array<std::size_t, kSampledAovs.size()> first_{};  ///< index in the film, or kNone
};

}  // namespace microtrace
