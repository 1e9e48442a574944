#include "render/lights/lighting.hpp"

#include "render/bsdf/ggx.hpp"
#include "render/kernels/lane_access.hpp"
#include "render/lights/map_light.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
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

/// Directions that are sampled by the visibility of the environment.
class GuidedDirections {
 public:
  explicit GuidedDirections(const std::array<const EnvironmentGuide::Cell*, kShadingLanes>& cells) {
    for (int lane = 0; lane < kShadingLanes; ++lane) {
      const EnvironmentGuide::Cell* cell = cells[static_cast<std::size_t>(lane)];
      parts_[lane] = cell != nullptr ? cell->part() : 0;
      lanes_.tables[lane] = parts_[lane] > 0 ? &cell->directions() : nullptr;
    }
    is_any_ = complete_tables(lanes_);
  }

  /// Samples unit directions. At least one cell must have a part.
  [[nodiscard]] const auto& sample(const ShadingKernels& kernels, const LaneFloats (&u)[2]) {
    copy(lanes_.u, u);
    kernels.sample_guides(lanes_);
    return lanes_.wi;
  }
  /// Changes the pdfs of these lanes' directions in the environment's distribution to those in the
  /// mixture with the guide.
  void mix_pdfs(const ShadingKernels& kernels, Lanes which, const LaneFloats (&wi)[3],
                LaneFloats& pdfs) {
    if (!is_any_) return;
    copy(lanes_.wi, wi);
    kernels.guide_pdfs(lanes_);
    for (; which != 0; which &= which - 1) {
      const int lane = std::countr_zero(which);
      if (parts_[lane] > 0)
        pdfs[lane] = parts_[lane] * lanes_.pdf[lane] + (1 - parts_[lane]) * pdfs[lane];
    }
  }

 private:
  bool is_any_ = false;
  LaneFloats parts_;
  GuideLanes<kShadingLanes> lanes_{};
};

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

Lighting::Cells Lighting::cells(Lanes lanes, const LightChoices<kShadingLanes>& points) const {
  Cells cells{};
  for (Lanes rest = guide_ ? lanes : 0; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    cells[static_cast<std::size_t>(lane)] = cell(got(points.p, lane), got(points.n, lane));
  }
  return cells;
}

void Lighting::sample_environment(const ShadingKernels& kernels, const Cells& cells, int count,
                                  const Choices& all_choices,
                                  LightSamples<kShadingLanes>& samples) const {
  const LightChoices<kShadingLanes>& choices = all_choices.points;
  const TriangleChoices<kShadingLanes>& triangles = all_choices.triangles;
  std::array<Vec2, kShadingLanes> u;
  std::array<int, kShadingLanes> lanes;
  std::size_t free = 0;
  Lanes by_visibility = 0;
  for (int lane = 0; lane < count; ++lane) {
    const EnvironmentGuide::Cell* own_cell = cells[static_cast<std::size_t>(lane)];
    if (choices.kind[lane] != LightKind::environment || !samples_environment(own_cell)) continue;
    // The kernel selects the environment with the lowest numbers.
    const float choice = choices.choice[lane] / choices.probability[lane];
    if (own_cell != nullptr && choice < own_cell->part()) {
      by_visibility |= Lanes{1} << lane;
      continue;
    }
    u[free] = Vec2(triangles.u[0][lane], triangles.u[1][lane]);
    lanes[free++] = lane;
  }
  std::array<EnvironmentLight::Sample, kShadingLanes> found;
  environment_->sample(std::span(u).first(free), found);
  std::optional<GuidedDirections> guided;
  if (guide_) guided.emplace(cells);
  const auto set = [&](int lane, const Vec3& wi, const Vec3& radiance, float own_pdf) {
    put_sample(samples, lane,
               {.to_light = wi, .is_far = true, .wi = wi, .light = radiance, .pdf = own_pdf});
  };
  if (by_visibility != 0) {
    const auto& directions = guided->sample(kernels, triangles.u);
    for (Lanes rest = by_visibility; rest != 0; rest &= rest - 1) {
      const int lane = std::countr_zero(rest);
      const Vec3 wi = got(directions, lane);
      const EnvironmentLight::Lookup look = environment_->lookup(wi);
      set(lane, wi, look.radiance, look.pdf);
    }
  }
  Lanes selected = by_visibility;
  for (std::size_t i = 0; i < free; ++i) {
    set(lanes[i], found[i].wi, found[i].radiance, found[i].pdf);
    selected |= Lanes{1} << lanes[i];
  }
  if (guided) guided->mix_pdfs(kernels, selected, samples.wi, samples.pdf);
  for (Lanes rest = selected; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    samples.pdf[lane] *= choices.probability[lane];
    put(samples.light, lane, got(samples.light, lane) / samples.pdf[lane]);
  }
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
  const Cells found = cells((Lanes{1} << count) - 1, points);
  for (int lane = 0; lane < count; ++lane)
    points.share[lane] = share(found[static_cast<std::size_t>(lane)]);
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
  if (samples_environment()) sample_environment(kernels, found, count, choices, samples);
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
  const Cells found = cells(lanes, origins);
  for (int lane = 0; lane < kShadingLanes; ++lane) {
    const EnvironmentGuide::Cell* own_cell = found[static_cast<std::size_t>(lane)];
    origins.share[lane] = share(own_cell);
    if (!samples_environment(own_cell)) lights.pdf[lane] = 0;
  }
  if (guide_) GuidedDirections(found).mix_pdfs(kernels, lanes, lights.d, lights.pdf);
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
