#include "render/integrators/wavefront/vertices/guided_vertices.hpp"

#include "render/lanes/lane_access.hpp"

#include <array>
#include <span>

namespace microtrace {
namespace {

/// The probability of sampling the guide.
constexpr float kPart = 0.35F;

/// True for smooth metals and glass, whose reflections the BSDF samples better than the guide.
bool is_smooth(const SurfaceLanes& surface, int lane, bool refracts) {
  constexpr float kLeastRoughness = 0.3F;
  return surface.roughness[lane] < kLeastRoughness && (refracts || surface.metallic[lane] > 0.5F);
}

}  // namespace

void GuidedVertices::scatter(const PathGuide& guide, const ShadingKernels& kernels,
                             ScatterSetup setup, const Points& points, ScatterLanes& lanes) {
  setup.is_guided = true;
  kernels.random_pairs(lanes.key, lanes.index, setup.direction_pair, lanes.u[0], lanes.u[1]);
  kernels.random_pairs(lanes.key, lanes.index, setup.lobe_pair, lanes.chances[0], lanes.chances[1]);
  const bool is_guided = find_tables(guide, setup.features.refracts, points, lanes);
  if (is_guided) {
    copy(directions_.wi, lanes.light_wi);
    kernels.guide_pdfs(directions_);
    copy(lanes.light_guide_pdf, directions_.pdf);
    copy(directions_.u, lanes.u);
    kernels.sample_guides(directions_);
    copy(lanes.guide_wi, directions_.wi);
  }
  kernels.scatter(setup, lanes);
  if (is_guided) {
    copy(directions_.wi, lanes.wi);
    kernels.guide_pdfs(directions_);
    copy(lanes.guide_pdf, directions_.pdf);
  }
  kernels.finish_guided(setup.most_survival, lanes);
}

bool GuidedVertices::find_tables(const PathGuide& guide, bool refract, const Points& points,
                                 ScatterLanes& lanes) {
  std::array<const PathGuide::Cell*, kShadingLanes> cells{};
  guide.find({points.p[0], points.p[1], points.p[2]},
             {lanes.frame_n[0], lanes.frame_n[1], lanes.frame_n[2]},
             std::span(cells).first(static_cast<std::size_t>(points.count)));
  for (int lane = 0; lane < kShadingLanes; ++lane) {
    const bool smooth = is_smooth(lanes.surface, lane, refract);
    // The guide knows no directions below the surface. Paths that cross rough glass several times
    // would get weights that grow each time.
    const bool is_guided = !smooth && !refract;
    const PathGuide::Cell* cell = is_guided ? cells[static_cast<std::size_t>(lane)] : nullptr;
    lanes.is_smooth[lane] = smooth ? 1 : 0;
    lanes.guide_part[lane] = cell != nullptr ? kPart : 0;
    lanes.brightness[lane] = cell != nullptr ? cell->brightness : -1;
    directions_.tables[lane] = cell != nullptr ? &cell->directions.table() : nullptr;
  }
  return complete_tables(directions_);
}

}  // namespace microtrace
