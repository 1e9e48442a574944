#include "render/lights/lighting.hpp"

#include "render/bsdf/ggx.hpp"
#include "render/kernels/lane_access.hpp"
#include "render/lights/map_light.hpp"

#include <algorithm>
#include <array>
#include <bit>
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
  return std::max(cell->openness(), kLeast) / kLeastMapPart;
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
  auto& [points, triangles, punctual] = choices;
  const std::uint32_t light = points.light[lane];
  const Vec2 u(triangles.u[0][lane], triangles.u[1][lane]);
  if (const std::optional<std::uint32_t> triangle = emitters_.triangle_index(light)) {
    triangles.selected[lane] = 1;
    triangles.triangle[lane] = *triangle;
    emitters_.put_textured(*triangle, u, lane, triangles);
    return;
  }
  if (const std::optional<std::uint32_t> index = emitters_.punctual_index(light)) {
    punctual.selected[lane] = 1;
    punctual.light[lane] = *index;
    punctual.group_size[lane] = 1;
    return;
  }
  const auto sample =
      emitters_.sample_shape(light, got(points.p, lane), u, double{points.probability[lane]});
  if (sample) put_sample(samples, lane, *sample);
}

void Lighting::sample(const ShadingKernels& kernels, int count, Choices& choices,
                      LightSamples<kShadingLanes>& samples) const {
  auto& [points, triangles, punctual] = choices;
  for (int lane = 0; lane < count; ++lane)
    points.share[lane] = guide_ ? share(cell(got(points.p, lane), got(points.n, lane))) : 1;
  kernels.choose_lights(setup_, points);
  for (auto& light : samples.light) std::ranges::fill(light, 0.0F);
  std::ranges::fill(samples.target, LightSamples<kShadingLanes>::kNoTarget);
  std::ranges::fill(triangles.selected, 0.0F);
  std::ranges::fill(triangles.triangle, 0U);
  std::ranges::fill(punctual.selected, 0.0F);
  std::ranges::fill(punctual.light, 0U);
  for (int lane = 0; lane < count; ++lane) {
    if (points.kind[lane] == LightKind::near) {
      sample_near(lane, choices, samples);
    } else if (points.kind[lane] == LightKind::far) {
      punctual.selected[lane] = 1;
      punctual.light[lane] = emitters_.far_light(points.choice[lane]);
      punctual.group_size[lane] = static_cast<float>(emitters_.far_count());
    }
  }
  if (samples_environment()) sample_environment(count, choices, samples);
  const auto is_any = [](const LaneFloats& selected) {
    return std::ranges::any_of(selected, [](float one) { return one != 0; });
  };
  if (is_any(triangles.selected))
    kernels.sample_triangles(emitters_.triangles(), triangles, points, samples);
  if (is_any(punctual.selected))
    kernels.sample_punctual(emitters_.punctual(), punctual, points, samples);
}

void Lighting::environment(const ShadingKernels& kernels, Lanes lanes, bool from_camera,
                           Escapes& escapes) const {
  auto& [lights, origins] = escapes;
  kernels.normalize(lights.d);
  environment_->look_up(lanes, lights);
  if (from_camera) return;
  if (!samples_environment()) {
    std::ranges::fill(lights.pdf, 0.0F);
    return;
  }
  std::ranges::fill(origins.share, 1.0F);
  for (Lanes rest = guide_ ? lanes : 0; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    const auto* own_cell = cell(got(origins.p, lane), got(origins.n, lane));
    origins.share[lane] = share(own_cell);
    lights.pdf[lane] =
        samples_environment(own_cell) ? pdf(own_cell, got(lights.d, lane), lights.pdf[lane]) : 0;
  }
  kernels.environment_probabilities(setup_, origins);
  for (int lane = 0; lane < kShadingLanes; ++lane) lights.pdf[lane] *= origins.probability[lane];
}

float Lighting::emitter_pdf(PrimitiveId id, const LightSampleContext& context, float distance,
                            float cosine) const {
  const std::optional<std::size_t> light = emitters_.find(id);
  if (!light || !(cosine > 0)) return 0;
  const KindProbabilities<1> kinds = probabilities(context, cell(context.p, context.n));
  return emitters_.pdf(*light, context, distance, cosine, double{kinds.near});
}

}  // namespace microtrace
