#pragma once
#include <microtrace/integrator.hpp>
#include <microtrace/ray.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>

namespace microtrace {

/// A batch of rays for the integrator, and each ray's pixel.
template <std::size_t Size>
class RayBatch {
 public:
  /// Samples for which the camera has no ray are opaque black, or transparent if the film has
  /// alpha. Integrators whose results are data determine the values of these samples themselves.
  RayBatch(const Integrator& integrator, bool has_alpha)
      : integrator_(integrator),
        no_ray_{.color = Vec3(0), .alpha = has_alpha ? 0.0F : 1.0F},
        is_data_(integrator.is_data()) {}

  [[nodiscard]] bool is_full() const { return count_ == Size; }

  void add(std::size_t pixel, const SampleId& id) {
    ids_[count_] = id;
    pixels_[count_++] = pixel;
  }
  [[nodiscard]] std::span<const SampleId> ids() const { return std::span(ids_).first(count_); }
  /// The rays of these samples, which the caller sets.
  [[nodiscard]] std::span<Ray> rays() { return std::span(rays_).first(count_); }

  struct Results {
    std::span<const std::size_t> pixels;
    std::span<const Sample> samples;
  };
  /// Traces the rays and clears the batch. The results, in the order of the rays, are valid until
  /// the next call.
  [[nodiscard]] Results trace(const World& world) {
    integrator_.trace(world, std::span(rays_).first(count_), std::span(ids_).first(count_),
                      std::span(samples_).first(count_));
    if (!is_data_) {
      for (std::size_t i = 0; i < count_; ++i) {
        // RayGenerator marks missing rays by a negative t_max.
        if (!(rays_[i].t_max >= 0)) samples_[i] = no_ray_;
      }
    }
    return take_results();
  }
  /// Does the same without rays for samples that are known to be equal.
  [[nodiscard]] Results fill(const Sample& sample) {
    std::fill_n(samples_.begin(), count_, sample);
    return take_results();
  }

 private:
  [[nodiscard]] Results take_results() {
    const std::size_t count = std::exchange(count_, 0);
    return {.pixels = std::span(pixels_).first(count), .samples = std::span(samples_).first(count)};
  }

  const Integrator& integrator_;
  Sample no_ray_;
  bool is_data_;
  std::size_t count_ = 0;
  std::array<Ray, Size> rays_;
  std::array<SampleId, Size> ids_;
  std::array<std::size_t, Size> pixels_;
  std::array<Sample, Size> samples_;
};

}  // namespace microtrace
