#pragma once
#include <microtrace/integrator.hpp>
#include <microtrace/ray.hpp>

#include <array>
#include <cstddef>
#include <new>
#include <span>

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

  /// Adds the ray that make_ray() returns. The ray is created in place, because copying a struct
  /// that was just written in parts is slow.
  template <class MakeRay>
  void add(std::size_t pixel, const SampleId& id, const MakeRay& make_ray) {
    ::new (&rays_[count_]) Ray(make_ray());
    ids_[count_] = id;
    pixels_[count_++] = pixel;
  }

  /// Traces the rays, calls f(pixel, sample) in the order of the rays, and clears the batch.
  template <class F>
  void trace(const World& world, F&& f) {
    integrator_.trace(world, std::span(rays_).first(count_), std::span(ids_).first(count_),
                      std::span(samples_).first(count_));
    for (std::size_t i = 0; i < count_; ++i) {
      // RayGenerator marks missing rays by a negative t_max.
      const bool has_ray = rays_[i].t_max >= 0;
      f(pixels_[i], has_ray || is_data_ ? samples_[i] : no_ray_);
    }
    count_ = 0;
  }

 private:
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
