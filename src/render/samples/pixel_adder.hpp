#pragma once
/// Adds batches of samples to the sums of pixels.

#include "render/film/ray_batch.hpp"
#include "render/lanes/shading_kernels.hpp"

#include <microtrace/integrator.hpp>
#include <microtrace/math.hpp>
#include <microtrace/sample_sums.hpp>

#include <cstdint>
#include <span>

namespace microtrace {

/// PixelSum::add() for the pixels of a tile, several samples at a time.
class PixelAdder {
 public:
  /// places[i] is the index in `sums` of the batches' pixel i, at most TermSums::kPixels of them.
  /// All arguments must outlive this object.
  PixelAdder(const ShadingKernels& kernels, const Vec3& background, std::span<PixelSum> sums,
             std::span<const std::size_t> places);

  /// Adds at most 1024 samples, fastest if each of sixteen consecutive pixels has the same number
  /// of consecutive samples.
  void add(const RayBatch<kRandomBatch>::Results& batch);

  /// The number of samples, and the number of samples that were NaN.
  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  [[nodiscard]] std::uint64_t invalid() const { return invalid_; }

 private:
  using Results = RayBatch<kRandomBatch>::Results;

  /// The number of samples of each of kShadingLanes consecutive pixels, whose samples start at
  /// `first`; 0 if their numbers differ.
  [[nodiscard]] static std::size_t samples_per_pixel(const Results& batch, std::size_t first);
  void add_one(std::size_t pixel, const Sample& sample);
  /// Moves the terms of a batch to the pixels.
  void move_terms();

  const ShadingKernels& kernels_;
  Vec3 background_;
  std::span<PixelSum> sums_;
  std::span<const std::size_t> places_;
  SumSetup setup_{};
  TermSums terms_{};
  std::uint64_t samples_ = 0, invalid_ = 0;
};

}  // namespace microtrace
