#pragma once
/// The light of a picture: emitters and environment, and which of them a point should sample.

#include "render/lights/emitters.hpp"
#include "render/lights/environment_light.hpp"
#include "render/lights/light_sample.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>

#include <optional>

namespace microtrace {

/// Immutable; any number of threads may use it.
class Lighting {
 public:
  /// The emitters must outlive this. `is_seen`: whether the environment is visible to camera rays.
  Lighting(const Emitters& emitters, std::optional<EnvironmentLight> environment, bool is_seen);

  /// Samples a light for a point: `choice` selects the light, u the position on it. Nothing if the
  /// selected light is not sampled: a uniform environment is left to BSDF sampling.
  [[nodiscard]] std::optional<LightSample> sample(const LightSampleContext& context, const Vec2& u,
                                                  float choice) const;

  /// Whether sample() can return light.
  [[nodiscard]] bool can_sample() const {
    return emitters_.has_near() || emitters_.has_far() || samples_environment();
  }

  /// Whether paths can hit light: the environment or emissive surfaces.
  [[nodiscard]] bool may_surround() const { return environment_ || emitters_.has_surfaces(); }

  /// Whether the environment is visible to camera rays.
  [[nodiscard]] bool is_seen() const { return is_seen_; }

  /// Radiance from a unit direction.
  [[nodiscard]] Vec3 environment(const Vec3& wi) const {
    return environment_ ? environment_->radiance(wi) : Vec3(0);
  }
  /// The same, with the pdf with which sample() returns this direction for the context.
  [[nodiscard]] EnvironmentLight::Lookup environment(const LightSampleContext& context,
                                                     const Vec3& wi) const;

  /// The pdf with which sample() returns a point of an emissive surface, for a path that arrives
  /// there from the context after `distance`; `cosine` is between the path and the surface's
  /// normal.
  [[nodiscard]] float emitter_pdf(PrimitiveId id, const LightSampleContext& context, float distance,
                                  float cosine) const;

 private:
  /// Selection probabilities at a point: of the environment, far lights, near lights.
  struct Probabilities {
    float environment = 0, far = 0, near = 0;
  };
  [[nodiscard]] Probabilities probabilities(const LightSampleContext& context) const;
  [[nodiscard]] bool samples_environment() const {
    return environment_ && !environment_->is_uniform();
  }

  const Emitters& emitters_;
  std::optional<EnvironmentLight> environment_;
  bool is_seen_;
  double environment_light_ = 0;  // approximate irradiance of a surface
};

}  // namespace microtrace
