#include "render/lighting/lighting.hpp"

#include "render/bsdf/ggx.hpp"
#include "render/lanes/lane_access.hpp"

#include <algorithm>
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

/// Prefetches what sample_guides() reads for the first random numbers u. The tables of all cells
/// don't fit into the fastest caches.
void prefetch_samples(const GuideTable* const (&tables)[kShadingLanes], const LaneFloats& u) {
  for (int lane = 0; lane < kShadingLanes; ++lane) {
    const GuideTable& table = *tables[lane];
    __builtin_prefetch(&table.axis);
    __builtin_prefetch(&table.slots[static_cast<int>(u[lane] * GuideTable::kSlots)]);
  }
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

void Lighting::find_cells(const ShadingKernels& kernels, Lanes lanes,
                          LightChoices<kShadingLanes>& points,
                          EnvironmentCells<kShadingLanes>& cells) const {
  std::ranges::fill(points.share, 1.0F);
  std::ranges::fill(cells.part, 0.0F);
  cells.is_any = false;
  cells.is_uniform = environment_ && environment_->is_uniform();
  if (!guide_) return;
  std::uint32_t indices[kShadingLanes];
  kernels.find_sky_cells(guide_->grid(), points.p, points.n, indices);
  std::ranges::fill(cells.guides.tables, nullptr);
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const EnvironmentGuide::Cell& cell = guide_->at(indices[lane]);
    points.share[lane] = cell.share;
    cells.part[lane] = cell.part;
    cells.guides.tables[lane] = cell.directions;
  }
  cells.is_any = complete_tables(cells.guides);
}

void Lighting::sample_environment(const ShadingKernels& kernels, int count, Choices& choices,
                                  LightSamples<kShadingLanes>& samples) const {
  EnvironmentSamples<kShadingLanes>& found = choices.environment;
  kernels.split_environment(choices.points, count, found);
  const LaneFloats(&u)[2] = choices.triangles.u;
  if (found.lanes_independent != 0)
    environment_->sample(found.lanes_independent, u, found.independent);
  if (found.lanes_by_visibility != 0) {
    copy(found.cells.guides.u, u);
    kernels.sample_guides(found.cells.guides);
    copy(found.visible.d, found.cells.guides.wi);
    environment_->look_up(found.lanes_by_visibility, found.visible);
  }
  if ((found.lanes_independent | found.lanes_by_visibility) != 0)
    kernels.finish_environment(choices.points, found, samples);
}

void Lighting::sample_near(int lane, Choices& choices, LightSamples<kShadingLanes>& samples) const {
  auto& [points, triangles, punctual, environment] = choices;
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
  auto& [points, triangles, punctual, environment] = choices;
  find_cells(kernels, (Lanes{1} << count) - 1, points, environment.cells);
  if (environment.cells.is_any) prefetch_samples(environment.cells.guides.tables, triangles.u[0]);
  kernels.choose_lights(setup_, points);
  for (auto& light : samples.light) std::ranges::fill(light, 0.0F);
  std::ranges::fill(samples.target, LightSamples<kShadingLanes>::kNoTarget);
  if (samples_environment()) sample_environment(kernels, count, choices, samples);
  if (!emitters_.has_near() && !emitters_.has_far()) return;
  std::ranges::fill(triangles.selected, 0.0F);
  std::ranges::fill(triangles.triangle, 0U);
  std::ranges::fill(punctual.selected, 0.0F);
  std::ranges::fill(punctual.light, 0U);
  const std::uint32_t* const untextured = emitters_.untextured_triangles();
  for (int lane = 0; lane < count; ++lane) {
    if (points.kind[lane] == LightKind::near) {
      const std::uint32_t triangle = untextured[points.light[lane]];
      if (triangle != Emitters::kNone) {
        triangles.selected[lane] = 1;
        triangles.triangle[lane] = triangle;
      } else {
        sample_near(lane, choices, samples);
      }
    } else if (points.kind[lane] == LightKind::far) {
      punctual.selected[lane] = 1;
      punctual.light[lane] = emitters_.far_light(points.choice[lane]);
      punctual.group_size[lane] = static_cast<float>(emitters_.far_count());
    }
  }
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
  auto& [lights, origins, cells] = escapes;
  kernels.normalize(lights.d);
  environment_->look_up(lanes, lights);
  if (from_camera) return;
  if (!samples_environment()) {
    std::ranges::fill(lights.pdf, 0.0F);
    return;
  }
  find_cells(kernels, lanes, origins, cells);
  kernels.mix_environment_pdfs(lights.d, cells, lights.pdf);
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
