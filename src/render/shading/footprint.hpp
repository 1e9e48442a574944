#pragma once
#include <microtrace/camera.hpp>
#include <microtrace/ray.hpp>

#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace {

/// The width of a path's footprint, in world space.
struct Footprint {
  float begin = 0;   ///< width at the ray's origin
  float spread = 0;  ///< growth with distance

  [[nodiscard]] float at(float distance) const { return begin + spread * distance; }
};

/// The footprint of a camera ray. `sample_width` is the distance between samples in pixels.
[[nodiscard]] inline Footprint camera_footprint(const RayGenerator& camera, const Ray& ray,
                                                float sample_width) {
  const RayDifferential step = camera.differential(ray);
  const DVec3 d(ray.d);
  const double spread = std::sqrt(glm::dot(step.d_dy, step.d_dy) / glm::dot(d, d));
  const double begin = std::sqrt(glm::dot(step.o_dy, step.o_dy));
  return {.begin = static_cast<float>(begin) * sample_width,
          .spread = static_cast<float>(spread) * sample_width};
}

}  // namespace microtrace
