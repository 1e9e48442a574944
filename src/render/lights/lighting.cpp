#include "render/lights/lighting.hpp"

#include "render/bsdf/ggx.hpp"
#include "render/sampling/warps.hpp"

#include <algorithm>
#include <utility>

namespace microtrace {

Lighting::Lighting(const Emitters& emitters, std::optional<EnvironmentLight> environment,
                   bool is_seen)
    : emitters_(emitters), environment_(std::move(environment)), is_seen_(is_seen) {
  if (environment_)
    environment_light_ = double{environment_->sampled_luminance() / bsdf::kInversePi};
}

// In proportion to the estimated contributions, with a minimum probability. A uniform environment
// also has a probability, although it isn't sampled, so that fewer samples are spent where other
// lights contribute little. Its estimate is reduced, because indoors little of it may arrive.
Lighting::Probabilities Lighting::probabilities(const LightSampleContext& context) const {
  constexpr float least = 0.1F;
  const double near = emitters_.near_light(context);
  const double sum = environment_light_ + emitters_.far_light() + near;
  const auto part = [&](bool is_there, double light) {
    return is_there ? std::max(sum > 0 ? static_cast<float>(light / sum) : 0, least) : 0;
  };
  const Probabilities raw{.environment = part(environment_light_ > 0, environment_light_),
                          .far = part(emitters_.has_far(), emitters_.far_light()),
                          .near = part(emitters_.has_near(), near)};
  const float all = raw.environment + raw.far + raw.near;
  if (all == 0) return {};
  return {.environment = raw.environment / all, .far = raw.far / all, .near = raw.near / all};
}

std::optional<LightSample> Lighting::sample(const LightSampleContext& context, const Vec2& u,
                                            float choice) const {
  const Probabilities probability = probabilities(context);
  if (choice < probability.environment) {
    if (!samples_environment()) return std::nullopt;
    const EnvironmentLight::Sample s = environment_->sample(u);
    const float pdf = s.pdf * probability.environment;
    return LightSample{
        .to_light = s.wi, .is_far = true, .wi = s.wi, .light = s.radiance / pdf, .pdf = pdf};
  }
  choice -= probability.environment;
  if (probability.near == 0 || choice < probability.far) {
    if (probability.far == 0) return std::nullopt;
    return emitters_.sample_far(context, choice / probability.far, double{probability.far});
  }
  return emitters_.sample_near(context, u,
                               sampling::reused(choice, probability.far, probability.near),
                               double{probability.near});
}

EnvironmentLight::Lookup Lighting::environment(const LightSampleContext& context,
                                               const Vec3& wi) const {
  if (!samples_environment()) return {.radiance = environment(wi), .pdf = 0};
  EnvironmentLight::Lookup look = environment_->lookup(wi);
  look.pdf *= probabilities(context).environment;
  return look;
}

float Lighting::emitter_pdf(PrimitiveId id, const LightSampleContext& context, float distance,
                            float cosine) const {
  const std::optional<std::size_t> light = emitters_.find(id);
  if (!light || !(cosine > 0)) return 0;
  return emitters_.pdf(*light, context, distance, cosine, double{probabilities(context).near});
}

}  // namespace microtrace
