#include "render/lights/lighting.hpp"

#include "render/bsdf/ggx.hpp"
#include "render/kernels/lane_access.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace microtrace {
namespace {

void put_sample(LightSamples<kShadingLanes>& lanes, int lane, const LightSample& sample) {
  lanes.is_far[lane] = sample.is_far ? 1.0F : 0.0F;
  put(lanes.to_light, lane, sample.to_light);
  put(lanes.wi, lane, sample.wi);
  put(lanes.light, lane, sample.light);
  lanes.pdf[lane] = sample.pdf;
  lanes.target[lane] = sample.target.value_or(LightSamples<kShadingLanes>::kNoTarget);
}

}  // namespace

Lighting::Lighting(const Emitters& emitters, std::optional<EnvironmentLight> environment,
                   bool is_seen, const SkyVisibility* visibility)
    : emitters_(emitters), is_seen_(is_seen), setup_(emitters.choice_setup()) {
  if (!environment) return;
  environment_ = std::make_unique<const EnvironmentLight>(*std::move(environment));
  // approximate irradiance on a surface
  setup_.environment_light =
      setup_.irradiance(double{environment_->sampled_luminance() / bsdf::kInversePi});
  if (visibility != nullptr && environment_->sampled_luminance() > 0)
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

void Lighting::sample_environment(int count, const Choices& all_choices,
                                  LightSamples<kShadingLanes>& samples) const {
  const LightChoices<kShadingLanes>& choices = all_choices.points;
  const TriangleChoices<kShadingLanes>& triangles = all_choices.triangles;
  const auto set = [&](int lane, const EnvironmentGuide::Cell* own_cell, const Vec3& wi,
                       const Vec3& radiance, float own_pdf) {
    const float all = pdf(own_cell, wi, own_pdf) * choices.probability[lane];
    put_sample(samples, lane,
               {.to_light = wi, .is_far = true, .wi = wi, .light = radiance / all, .pdf = all});
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
    const float choice = choices.choice[lane] / choices.probability[lane];
    if (own_cell != nullptr && choice < own_cell->part()) {
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

void Lighting::sample_near(int lane, Choices& choices, LightSamples<kShadingLanes>& samples) const {
  auto& [points, triangles] = choices;
  const std::uint32_t light = points.light[lane];
  const Vec2 u(triangles.u[0][lane], triangles.u[1][lane]);
  if (const std::optional<std::uint32_t> triangle = emitters_.triangle_index(light)) {
    triangles.selected[lane] = 1;
    triangles.triangle[lane] = *triangle;
    emitters_.put_textured(*triangle, u, lane, triangles);
    return;
  }
  const auto sample =
      emitters_.sample_near(light, got(points.p, lane), u, double{points.probability[lane]});
  if (sample) put_sample(samples, lane, *sample);
}

void Lighting::sample(const ShadingKernels& kernels, int count, Choices& choices,
                      LightSamples<kShadingLanes>& samples) const {
  auto& [points, triangles] = choices;
  for (int lane = 0; lane < count; ++lane)
    points.share[lane] = guide_ ? share(cell(got(points.p, lane), got(points.n, lane))) : 1;
  kernels.choose_lights(setup_, points);
  for (auto& light : samples.light) std::ranges::fill(light, 0.0F);
  std::ranges::fill(samples.target, LightSamples<kShadingLanes>::kNoTarget);
  std::ranges::fill(triangles.selected, 0.0F);
  std::ranges::fill(triangles.triangle, 0U);
  for (int lane = 0; lane < count; ++lane) {
    if (points.kind[lane] == LightKind::near) {
      sample_near(lane, choices, samples);
    } else if (points.kind[lane] == LightKind::far) {
      const auto sample = emitters_.sample_far(got(points.p, lane), points.choice[lane],
                                               double{points.probability[lane]});
      if (sample) put_sample(samples, lane, *sample);
    }
  }
  if (samples_environment()) sample_environment(count, choices, samples);
  if (std::ranges::any_of(triangles.selected, [](float selected) { return selected != 0; }))
    kernels.sample_triangles(emitters_.triangles(), triangles, points, samples);
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
