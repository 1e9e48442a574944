#include "render/lights/lighting.hpp"

#include "render/bsdf/ggx.hpp"
#include "render/kernels/lane_access.hpp"

#include <array>
#include <utility>

namespace microtrace {

Lighting::Lighting(const Emitters& emitters, std::optional<EnvironmentLight> environment,
                   bool is_seen, const SkyVisibility* visibility)
    : emitters_(emitters), is_seen_(is_seen), setup_(emitters.choice_setup()) {
  if (!environment) return;
  environment_ = std::make_unique<const EnvironmentLight>(*std::move(environment));
  // approximate irradiance on a surface
  setup_.environment_light = double{environment_->sampled_luminance() / bsdf::kInversePi};
  if (visibility != nullptr)
    guide_ = std::make_unique<const EnvironmentGuide>(*visibility, *environment_);
}

float Lighting::share(const EnvironmentGuide::Cell* cell) const {
  // The brightest parts of a map may be visible even if little of it is.
  if (cell == nullptr || !environment_->is_uniform()) return 1;
  constexpr float kLeast = 0x1p-6F;
  return std::max(cell->openness(), kLeast) / MapDistribution::kLeastPart;
}

float Lighting::pdf(const EnvironmentGuide::Cell* cell, const Vec3& wi, float own) const {
  if (cell == nullptr || cell->part() == 0) return own;
  return cell->part() * cell->pdf(wi) + (1 - cell->part()) * own;
}

void Lighting::sample_environment(int count, const LightChoices<kShadingLanes>& choices,
                                  const TriangleLights<kShadingLanes>& triangles,
                                  std::span<LightSample, kShadingLanes> samples) const {
  const auto set = [&](int lane, const EnvironmentGuide::Cell* own_cell, const Vec3& wi,
                       const Vec3& radiance, float own_pdf) {
    const float all = pdf(own_cell, wi, own_pdf) * static_cast<float>(choices.probability[lane]);
    samples[static_cast<std::size_t>(lane)] = {
        .to_light = wi, .is_far = true, .wi = wi, .light = radiance / all, .pdf = all};
  };
  std::array<Vec2, kShadingLanes> u;
  std::array<int, kShadingLanes> lanes;
  std::array<const EnvironmentGuide::Cell*, kShadingLanes> cells;
  std::size_t selected = 0;
  for (int lane = 0; lane < count; ++lane) {
    if (choices.kind[lane] != LightKind::environment) continue;
    const EnvironmentGuide::Cell* own_cell = cell(got(choices.p, lane), got(choices.n, lane));
    if (!samples_environment(own_cell)) continue;
    const Vec2 place(triangles.u[0][lane], triangles.u[1][lane]);
    // The kernel selects the environment with the lowest numbers.
    const double choice = double{choices.choice[lane]} / choices.probability[lane];
    if (own_cell != nullptr && choice < double{own_cell->part()}) {
      const Vec3 wi = own_cell->sample(place);
      const EnvironmentLight::Lookup look = environment_->lookup(wi);
      set(lane, own_cell, wi, look.radiance, look.pdf);
      continue;
    }
    u[selected] = place;
    cells[selected] = own_cell;
    lanes[selected++] = lane;
  }
  std::array<EnvironmentLight::Sample, kShadingLanes> found;
  environment_->sample(std::span(u).first(selected), found);
  for (std::size_t i = 0; i < selected; ++i)
    set(lanes[i], cells[i], found[i].wi, found[i].radiance, found[i].pdf);
}

void Lighting::sample(const ShadingKernels& kernels, int count,
                      LightChoices<kShadingLanes>& choices,
                      TriangleLights<kShadingLanes>& triangles,
                      std::span<LightSample, kShadingLanes> samples) const {
  for (int lane = 0; lane < count; ++lane)
    choices.share[lane] = share(cell(got(choices.p, lane), got(choices.n, lane)));
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
  const EnvironmentGuide::Cell* own_cell = cell(context.p, context.n);
  if (!samples_environment(own_cell)) return {.radiance = environment(wi), .pdf = 0};
  EnvironmentLight::Lookup look = environment_->lookup(wi);
  look.pdf = pdf(own_cell, wi, look.pdf) * probabilities(context, own_cell).environment;
  return look;
}

float Lighting::emitter_pdf(PrimitiveId id, const LightSampleContext& context, float distance,
                            float cosine) const {
  const std::optional<std::size_t> light = emitters_.find(id);
  if (!light || !(cosine > 0)) return 0;
  const KindProbabilities<1> kinds = probabilities(context, cell(context.p, context.n));
  return emitters_.pdf(*light, context, distance, cosine, double{kinds.near});
}

}  // namespace microtrace
