#include "render/integrators/guided_vertices.hpp"

#include "render/kernels/lane_access.hpp"
#include "render/luminance.hpp"

#include <algorithm>

namespace microtrace {
namespace {

/// The probability of sampling the guide.
constexpr float kPart = 0.5F;

/// True for smooth metals and glass, whose reflections the BSDF samples better than the guide.
bool is_smooth(const SurfaceLanes& surface, int lane, bool refracts) {
  constexpr float kLeastRoughness = 0.3F;
  return surface.roughness[lane] < kLeastRoughness && (refracts || surface.metallic[lane] > 0.5F);
}

/// The survival probability of a path with this throughput, if it had been sampled by the BSDF
/// only. It is in proportion to the light that the path is expected to find, not to the throughput,
/// which is small in the directions that the guide prefers (J. Vorba and J. Křivánek,
/// Adjoint-driven Russian roulette and splitting in light transport simulation, 2016).
float survival_of(const PathGuide::Cell* cell, const Vec3& throughput) {
  constexpr float kSurvival = 3, kLeast = 0.1F;
  const float plain = std::max({throughput.x, throughput.y, throughput.z});
  if (cell == nullptr) return plain;
  return std::max(kSurvival * luminance(throughput) * cell->brightness, kLeast * plain);
}

}  // namespace

void GuidedVertices::scatter(const PathGuide& guide, const ShadingKernels& kernels,
                             const WaveStep& step, ScatterSetup setup, const Points& points,
                             ScatterLanes& lanes) {
  setup.is_guided = true;
  prepare(guide, kernels, step, points, setup.features.refracts, lanes);
  kernels.scatter(setup, lanes);
  finish(step, points.count, lanes);
}

void GuidedVertices::prepare(const PathGuide& guide, const ShadingKernels& kernels,
                             const WaveStep& step, const Points& points, bool refract,
                             ScatterLanes& lanes) {
  kernels.random_pairs(lanes.key, lanes.index, step.pair(sampling::kDirectionPair), u_[0], u_[1]);
  kernels.random_pairs(lanes.key, lanes.index, step.pair(sampling::kLobePair), chances_[0],
                       chances_[1]);
  for (int lane = 0; lane < points.count; ++lane) {
    const auto k = static_cast<std::size_t>(lane);
    lanes.guide_part[lane] = lanes.light_guide_pdf[lane] = 0;
    is_smooth_[k] = is_smooth(lanes.surface, lane, refract);
    cells_[k] = is_smooth_[k] ? nullptr : guide.at(got(points.p, lane), got(lanes.frame_n, lane));
    if (cells_[k] == nullptr) continue;
    const GuideDistribution& directions = cells_[k]->directions;
    lanes.guide_part[lane] = kPart;
    if (lanes.light_pdf[lane] > 0)
      lanes.light_guide_pdf[lane] = directions.pdf(got(lanes.light_wi, lane));
    if (chances_[0][lane] < kPart)
      put(lanes.guide_wi, lane, directions.sample({u_[0][lane], u_[1][lane]}));
  }
}

void GuidedVertices::finish(const WaveStep& step, int count, ScatterLanes& lanes) const {
  for (int lane = 0; lane < count; ++lane) {
    const auto k = static_cast<std::size_t>(lane);
    const float own = lanes.pdf[lane], part = lanes.guide_part[lane];
    if (!(own > 0)) continue;
    float pdf = own * (1 - part);
    if (cells_[k] != nullptr) pdf += part * cells_[k]->directions.pdf(got(lanes.wi, lane));
    const Vec3 value = got(lanes.next_throughput, lane);
    Vec3 next = value / pdf;
    if (step.most_survival() < 1) {
      // Paths through glass are about to find light that other paths can't find.
      const float wanted = is_smooth_[k] ? 1 : survival_of(cells_[k], value / own);
      const float survival = std::min(wanted, step.most_survival());
      if (!(chances_[1][lane] < survival)) pdf = 0;
      next /= survival;
    }
    lanes.pdf[lane] = pdf;
    put(lanes.next_throughput, lane, next);
  }
}

}  // namespace microtrace
