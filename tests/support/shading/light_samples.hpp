#pragma once
/// Samples lights for a single shading point.

#include "render/lanes/dispatch.hpp"
#include "render/lanes/lane_access.hpp"
#include "render/lighting/lighting.hpp"

#include <array>
#include <optional>

namespace microtrace {

/// Samples one light. Returns nothing if the sample carries no light.
inline std::optional<LightSample> light_sample(const Lighting& lighting,
                                               const LightSampleContext& context, const Vec2& u,
                                               float choice) {
  Lighting::Choices choices;
  LightSamples<kShadingLanes> samples{};
  put(choices.points.p, 0, context.p);
  put(choices.points.n, 0, context.n);
  choices.points.choice[0] = choice;
  choices.triangles.u[0][0] = u.x;
  choices.triangles.u[1][0] = u.y;
  lighting.sample(kShadingKernels.best(), 1, choices, samples);
  const Vec3 light = got(samples.light, 0);
  if (light == Vec3(0)) return std::nullopt;
  const std::uint32_t target = samples.target[0];
  return LightSample{.to_light = got(samples.to_light, 0),
                     .is_far = samples.is_far[0] != 0,
                     .wi = got(samples.wi, 0),
                     .light = light,
                     .pdf = samples.pdf[0],
                     .target = target == samples.kNoTarget ? std::nullopt : std::optional(target)};
}

/// The pdf with which light_sample() samples this unit direction to the environment.
inline float environment_pdf(const Lighting& lighting, const LightSampleContext& context,
                             const Vec3& d) {
  if (!lighting.has_environment()) return 0;
  Lighting::Escapes escapes;
  put(escapes.lights.d, 0, d);
  put(escapes.origins.p, 0, context.p);
  put(escapes.origins.n, 0, context.n);
  lighting.environment(kShadingKernels.best(), 1, false, escapes);
  return escapes.lights.pdf[0];
}

/// A light chosen from the tree, and its probability. chosen_light() returns nothing if no light
/// reaches the point.
struct ChosenLight {
  std::size_t light;
  float probability;
};
inline std::optional<ChosenLight> chosen_light(const LightTree& tree, const Vec3& p, const Vec3& n,
                                               float u) {
  const LightChoice<1> choice =
      choose_light<1>(tree.nodes(), in_tree_units<1>(tree.space(), p), n, u, 1);
  if (!(choice.probability > 0)) return std::nullopt;
  return ChosenLight{.light = choice.light[0], .probability = choice.probability};
}

}  // namespace microtrace
