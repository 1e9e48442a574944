#pragma once
#include <microtrace/camera.hpp>

namespace microtrace {

/// The width of a path's footprint, in world space.
struct Footprint {
  float begin = 0;   ///< width at the ray's origin
  float spread = 0;  ///< growth with distance

  [[nodiscard]] float at(float distance) const { return begin + spread * distance; }
};

/// The footprint of a camera ray. `sample_width` is the distance between samples in pixels.
[[nodiscard]] inline Footprint camera_footprint(const RayGenerator::RowSpacing& spacing,
                                                float sample_width) {
  return {.begin = static_cast<float>(spacing.begin) * sample_width,
          .spread = static_cast<float>(spacing.spread) * sample_width};
}

}  // namespace microtrace
