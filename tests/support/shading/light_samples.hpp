#pragma once
/// Samples lights for a single shading point.

#include "render/kernels/dispatch.hpp"
#include "render/kernels/lane_access.hpp"
#include "render/lights/lighting.hpp"

#include <array>
#include <optional>

namespace microtrace {

/// Samples one light. Returns nothing if the sample carries no light.
inline std::optional<LightSample> light_sample(const Lighting& lighting,
                                               const LightSampleContext& context, const Vec2& u,
                                               float choice) {
  LightChoices<kShadingLanes> choices{};
  TriangleLights<kShadingLanes> triangles{};
  std::array<LightSample, kShadingLanes> samples;
  put(choices.p, 0, context.p);
  put(choices.n, 0, context.n);
  choices.choice[0] = choice;
  triangles.u[0][0] = u.x;
  triangles.u[1][0] = u.y;
  lighting.sample(kShadingKernels.best(), 1, choices, triangles, samples);
  if (samples[0].light == Vec3(0)) return std::nullopt;
  return samples[0];
}

/// A light chosen from the tree, and its probability. chosen_light() returns nothing if no light
/// reaches the point.
struct ChosenLight {
  std::size_t light;
  double probability;
};
inline std::optional<ChosenLight> chosen_light(const LightTree& tree, const Vec3& p, const Vec3& n,
                                               float u) {
  const LightChoice<1> choice = choose_light<1>(tree.nodes(), DVec3(p), n, u);
  if (!(choice.probability > 0)) return std::nullopt;
  return ChosenLight{.light = choice.light[0], .probability = choice.probability};
}

}  // namespace microtrace
