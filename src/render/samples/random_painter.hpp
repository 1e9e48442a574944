#pragma once
/// Adds samples of Monte Carlo integrators to sums.

#include "render/film/camera_rays.hpp"
#include "render/film/pixel_filter.hpp"
#include "render/film/ray_batch.hpp"
#include "render/lanes/shading_kernels.hpp"
#include "render/sampling/time_slice.hpp"

#include <microtrace/integrator.hpp>
#include <microtrace/render.hpp>
#include <microtrace/sample_sums.hpp>

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>

namespace microtrace {

/// Any number of threads may paint disjoint tiles.
class RandomPainter {
 public:
  /// `world` and `integrator` must outlive this object. Luminance is that of samples composited
  /// over this background. Only samples in this slice of time are added.
  RandomPainter(const World& world, const Integrator& integrator, const RenderOptions& options,
                const Vec3& background, const sampling::TimeSlice& slice = {});

  /// Adds the samples of this range to the sums of a tile's pixels, which are stored row by row.
  /// The tile has at most kTileEdge pixels per side. Ranges of 16 samples or more are most
  /// efficient.
  void add(const PixelRect& tile, const SampleRange& range, std::span<PixelSum> sums) const;

  /// The number of samples, and the number of samples that were NaN.
  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  [[nodiscard]] std::uint64_t invalid_samples() const { return invalid_; }

 private:
  class TilePixels;
  using Batch = RayBatch<kRandomBatch>;

  /// Returns the sample that all rays through the tile's pixels have, if that is known.
  [[nodiscard]] std::optional<Sample> common_sample(const PixelRect& tile) const;
  /// Makes the rays of the batch's samples.
  void make_rays(Batch& batch) const;

  const World& world_;
  const Integrator& integrator_;
  CameraRays ray_;
  FilterSampler filter_;
  Vec3 background_;
  bool has_alpha_;
  sampling::TimeSlice slice_;
  const ShadingKernels& kernels_;
  mutable std::atomic<std::uint64_t> samples_ = 0, invalid_ = 0;
};

}  // namespace microtrace
