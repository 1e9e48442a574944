#include "render/integrators/guided_vertices.hpp"

#include "render/kernels/lane_access.hpp"
#include "render/luminance.hpp"

#include <algorithm>
#include <cstdlib>

namespace microtrace {
namespace {

float env(const char* name, float value) {
  const char* text = std::getenv(name);
  return text ? static_cast<float>(std::atof(text)) : value;
}
const float kPart = env("G_PART", 0.5F), kSurvival = env("G_RR", 1);

/// The probability of sampling the guide. It is 0 on smooth metals and glass, whose reflections
/// the BSDF samples better.
float part_of(const ScatterLanes& lanes, int lane, bool refracts) {
  constexpr float kLeastRoughness = 0.3F;
  const SurfaceLanes& surface = lanes.surface;
  const bool is_smooth = surface.roughness[lane] < kLeastRoughness;
  if (is_smooth && (refracts || surface.metallic[lane] > 0.5F)) return 0;
  return kPart;
}

}  // namespace

void GuidedVertices::prepare(const PathGuide& guide, const ShadingKernels& kernels,
                             const WaveStep& step, int count, bool refracts, const LaneFloats (&p)[3],
                             ScatterLanes& lanes) {
  kernels.random_pairs(lanes.key, lanes.index, step.pair(sampling::kDirectionPair), u_[0], u_[1]);
  kernels.random_pairs(lanes.key, lanes.index, step.pair(sampling::kLobePair), chances_[0],
                       chances_[1]);
  brightness_ = guide.brightness();
  for (int lane = 0; lane < count; ++lane) {
    const auto k = static_cast<std::size_t>(lane);
    lanes.guide_part[lane] = 0;
    lanes.light_guide_pdf[lane] = 0;
    const float part = part_of(lanes, lane, refracts);
    is_smooth_[k] = part == 0;
    cells_[k] = part > 0 ? guide.at(got(p, lane), got(lanes.frame_n, lane)) : nullptr;
    if (cells_[k] == nullptr) continue;
    lanes.guide_part[lane] = part;
    if (lanes.light_pdf[lane] > 0)
      lanes.light_guide_pdf[lane] = cells_[k]->directions.pdf(got(lanes.light_wi, lane));
    if (chances_[0][lane] < part)
      put(lanes.guide_wi, lane, cells_[k]->directions.sample({u_[0][lane], u_[1][lane]}));
  }
}

void GuidedVertices::finish(const WaveStep& step, int count, ScatterLanes& lanes) const {
  const float most = step.most_survival();
  for (int lane = 0; lane < count; ++lane) {
    const auto k = static_cast<std::size_t>(lane);
    const float own = lanes.pdf[lane], part = lanes.guide_part[lane];
    float pdf = own * (1 - part);
    if (cells_[k] != nullptr) pdf += part * cells_[k]->directions.pdf(got(lanes.wi, lane));
    if (!(own > 0) || !(pdf > 0)) {
      lanes.pdf[lane] = 0;
      continue;
    }
    const Vec3 value = got(lanes.next_throughput, lane);
    Vec3 next = value / pdf;
    if (most < 1) {
      const Vec3 unguided = value / own;
      float survival = std::max({unguided.x, unguided.y, unguided.z});
      if (cells_[k] != nullptr)
        survival = std::max(0.1F * survival, kSurvival * luminance(unguided) *
                                                 cells_[k]->irradiance / (3.14159F * brightness_));
      if (lanes.guide_part[lane] == 0 && is_smooth_[k]) survival = 1;
      survival = std::min(survival, most);
      if (!(chances_[1][lane] < survival)) pdf = 0;
      next = next / survival;
    }
    lanes.pdf[lane] = pdf;
    put(lanes.next_throughput, lane, next);
  }
}

}  // namespace microtrace
