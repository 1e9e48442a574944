#pragma once
#include "render/lights/light_limits.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>

#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

namespace microtrace {

/// A light sample: the light that reaches a point from one direction unless it is occluded.
struct LightSample {
  Vec3 to_light{0};  ///< vector from the point to the light; of any length if the light is
                     ///< infinitely far away
  bool is_far = false;
  Vec3 wi{0, 0, 1};  ///< unit direction to the light
  Vec3 light{0};  ///< radiance / pdf; for punctual lights, irradiance on a surface that faces the
                  ///< light / selection probability
  float pdf = 0;  ///< per solid angle; 0 for punctual lights, which no path can hit
  std::optional<PrimitiveId> target{};  ///< the emitter, if it is a surface
};

/// A light sample without the selection probability. It is in float64, because float32 can't
/// represent the squares of all float32 distances.
struct FoundLight {
  DVec3 to_light{0};
  bool is_far = false;
  Vec3 wi{0, 0, 1};
  DVec3 light{0};
  double pdf = 0;
  std::optional<PrimitiveId> target{};

  /// Applies the probability of selecting this light among several.
  [[nodiscard]] LightSample with_probability(double probability) const {
    const double distance = std::sqrt(glm::dot(to_light, to_light));
    const auto selected = selected_light<1>(to_light, distance, wi, light, pdf, probability);
    return {.to_light = selected.to_light,
            .is_far = is_far || selected.is_far != 0,
            .wi = wi,
            .light = selected.light,
            .pdf = selected.pdf,
            .target = target};
  }
};

}  // namespace microtrace
