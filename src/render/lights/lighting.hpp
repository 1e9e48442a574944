#pragma once
/// The lighting of a picture: emitters, the environment, and light sampling.

#include "render/kernels/choose_lights.hpp"
#include "render/kernels/kernel.hpp"
#include "render/lights/emitters.hpp"
#include "render/lights/environment_light.hpp"
#include "render/lights/light_sample.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>

#include <optional>
#include <span>

namespace microtrace {

/// All light of a picture. Immutable; any number of threads may use it.
class Lighting {
 public:
  /// The emitters must outlive this object. `is_seen` is true if the environment is visible to
  /// camera rays.
  Lighting(const Emitters& emitters, std::optional<EnvironmentLight> environment, bool is_seen);

  /// Samples a light for each of `count` points. `choices.choice` selects the light, and
  /// `triangles.u` the position on it. If a uniform environment is selected, the sample has no
  /// light, because uniform environments are left to BSDF sampling. The other members of `choices`
  /// and `triangles` are working memory of the kernels.
  void sample(const ShadingKernels& kernels, int count, LightChoices<kShadingLanes>& choices,
              TriangleLights<kShadingLanes>& triangles,
              std::span<LightSample, kShadingLanes> samples) const;

  /// True if sample() can return light.
  [[nodiscard]] bool can_sample() const {
    return emitters_.has_near() || emitters_.has_far() || samples_environment();
  }

  /// True if paths can reach light by chance: the environment or emissive surfaces.
  [[nodiscard]] bool may_surround() const { return environment_ || emitters_.has_surfaces(); }

  /// True if the environment is visible to camera rays.
  [[nodiscard]] bool is_seen() const { return is_seen_; }

  /// The environment's radiance from a unit direction.
  [[nodiscard]] Vec3 environment(const Vec3& wi) const {
    return environment_ ? environment_->radiance(wi) : Vec3(0);
  }
  /// The radiance, and the pdf of this direction if sample() samples a light at the context.
  [[nodiscard]] EnvironmentLight::Lookup environment(const LightSampleContext& context,
                                                     const Vec3& wi) const;

  /// The pdf with which sample() would sample the point of an emissive surface that a path from the
  /// context hits after `distance`. `cosine` is the cosine of the angle between the path and the
  /// surface normal.
  [[nodiscard]] float emitter_pdf(PrimitiveId id, const LightSampleContext& context, float distance,
                                  float cosine) const;

 private:
  [[nodiscard]] KindProbabilities<1> probabilities(const LightSampleContext& context) const {
    return kind_probabilities<1>(setup_, DVec3(context.p), context.n);
  }
  /// Sets the samples of the lanes for which the environment is selected.
  void sample_environment(int count, const LightChoices<kShadingLanes>& choices,
                          const TriangleLights<kShadingLanes>& triangles,
                          std::span<LightSample, kShadingLanes> samples) const;
  [[nodiscard]] bool samples_environment() const {
    return environment_ && !environment_->is_uniform();
  }

  const Emitters& emitters_;
  std::optional<EnvironmentLight> environment_;
  bool is_seen_;
  LightChoiceSetup setup_;
};

}  // namespace microtrace
