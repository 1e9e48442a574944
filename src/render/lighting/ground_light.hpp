#pragma once
/// The light that arrives on a ground.

#include "render/lighting/hemisphere_distribution.hpp"

#include <microtrace/math.hpp>
#include <microtrace/scene.hpp>

#include <optional>

namespace microtrace {

/// Light from above on horizontal surfaces: the environment and punctual lights, without emissive
/// surfaces. Any number of threads may use it.
class GroundLight {
 public:
  /// The scene must outlive this object. `environment` may be null.
  GroundLight(const Scene& scene, const EnvironmentLight* environment);

  /// The least y of the scene's bounded shapes, in scene coordinates; nothing if there are none.
  [[nodiscard]] const std::optional<double>& lowest() const { return lowest_; }

  struct Sample {
    Vec3 to_light;  ///< vector to the light; of unit length if the light is infinitely far away
    bool is_far;
  };
  /// Samples a direction in proportion to the luminance of the irradiance that p, on the ground,
  /// receives from it in the absence of shapes. `choice` selects a light and u the direction; both
  /// are in [0, 1). Returns nothing if p receives no light.
  [[nodiscard]] std::optional<Sample> sample(const Vec3& p, float choice, const Vec2& u) const;

 private:
  const Scene& scene_;
  std::optional<double> lowest_;
  std::optional<HemisphereDistribution> sky_;
};

}  // namespace microtrace
