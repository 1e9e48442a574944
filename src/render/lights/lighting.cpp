#include "render/lights/lighting.hpp"

#include "render/bsdf/ggx.hpp"
#include "render/kernels/lane_access.hpp"

#include <array>
#include <utility>

namespace microtrace {

Lighting::Lighting(const Emitters& emitters, std::optional<EnvironmentLight> environment,
                   bool is_seen)
    : emitters_(emitters),
      environment_(std::move(environment)),
      is_seen_(is_seen),
      setup_(emitters.choice_setup()) {
  if (environment_)  // approximate irradiance on a surface
    setup_.environment_light = double{environment_->sampled_luminance() / bsdf::kInversePi};
}

void Lighting::sample_environment(int count, const LightChoices<kShadingLanes>& choices,
                                  const TriangleLights<kShadingLanes>& triangles,
                                  std::span<LightSample, kShadingLanes> samples) const {
  std::array<Vec2, kShadingLanes> u;
  std::array<int, kShadingLanes> lanes;
  std::size_t selected = 0;
  for (int lane = 0; lane < count; ++lane) {
    if (choices.kind[lane] != LightKind::environment) continue;
    u[selected] = {triangles.u[0][lane], triangles.u[1][lane]};
    lanes[selected++] = lane;
  }
  std::array<EnvironmentLight::Sample, kShadingLanes> found;
  environment_->sample(std::span(u).first(selected), found);
  for (std::size_t i = 0; i < selected; ++i) {
    const EnvironmentLight::Sample& s = found[i];
    const float pdf = s.pdf * static_cast<float>(choices.probability[lanes[i]]);
    samples[static_cast<std::size_t>(lanes[i])] = {
        .to_light = s.wi, .is_far = true, .wi = s.wi, .light = s.radiance / pdf, .pdf = pdf};
  }
}

void Lighting::sample(const ShadingKernels& kernels, int count,
                      LightChoices<kShadingLanes>& choices,
                      TriangleLights<kShadingLanes>& triangles,
                      std::span<LightSample, kShadingLanes> samples) const {
  kernels.choose_lights(setup_, choices);
  bool has_triangles = false;
  for (int lane = 0; lane < count; ++lane) {
    LightSample& sample = samples[static_cast<std::size_t>(lane)];
    const Vec2 u(triangles.u[0][lane], triangles.u[1][lane]);
    const std::uint32_t light = choices.light[lane];
    const double probability = choices.probability[lane];
    triangles.coverage[lane] = 0;
    sample = {};
    switch (choices.kind[lane]) {
      case LightKind::none:
      case LightKind::environment:
        break;
      case LightKind::far:
        sample = emitters_.sample_far(got(choices.p, lane), choices.choice[lane], probability)
                     .value_or(LightSample{});
        break;
      case LightKind::near:
        if (emitters_.is_triangle(light)) {
          put(triangles.p, lane, got(choices.p, lane));
          triangles.probability[lane] = probability;
          emitters_.put_triangle(light, lane, triangles);
          has_triangles = true;
        } else {
          sample = emitters_.sample_near(light, got(choices.p, lane), u, probability)
                       .value_or(LightSample{});
        }
        break;
    }
  }
  if (samples_environment()) sample_environment(count, choices, triangles, samples);
  if (!has_triangles) return;
  kernels.sample_triangles(triangles);
  for (int lane = 0; lane < count; ++lane) {
    if (triangles.coverage[lane] == 0 || triangles.pdf[lane] == 0) continue;
    samples[static_cast<std::size_t>(lane)] = {.to_light = got(triangles.to_light, lane),
                                               .is_far = triangles.is_far[lane] != 0,
                                               .wi = got(triangles.wi, lane),
                                               .light = got(triangles.light, lane),
                                               .pdf = triangles.pdf[lane],
                                               .target = emitters_.primitive(choices.light[lane])};
  }
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
