#include "render/shading/transmittance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// True if the ray, aimed at a point of `target` at t = 1, hits another triangle of this emitter
/// there, because the direction is rounded.
bool hits_beside(const Shading& shading, const Ray& ray, const Hit& hit, PrimitiveId target) {
  // The rounding of the two points and of their difference, with room for that of t.
  constexpr float kRounding = 0x1p-21F;
  if (!shading.is_same_emitter(hit.id, target)) return false;
  const Vec3 magnitude = glm::abs(ray.o) + glm::abs(ray.d);
  return std::abs(hit.t - 1) * glm::length(ray.d) <= kRounding * glm::length(magnitude);
}

}  // namespace

Vec3 transmittance(const Bvh& bvh, const Shading& shading, const PathOptions& options,
                   const Ray& ray, std::optional<Hit> hit, const std::optional<PrimitiveId>& target,
                   std::uint64_t& beyond, AroundRay around) {
  std::vector<std::pair<PrimitiveId, Vec3>> factors;
  while (hit && hit->id != target && !(target && hits_beside(shading, ray, *hit, *target))) {
    const ShadingPoint point = shading.point(ray, *hit);
    const Medium* own = Shading::enclosed_medium(point);
    // If the ray hits a front, the light comes from behind it.
    if (NestedMediaTable::is_hidden(own, point.at.front, around.here))
      around.here = around.table->without(around.here, *own);
    else if (!(passes_backs(options) && Shading::lets_light_in(point)))
      factors.emplace_back(hit->id, shading.transmittance(point, ray.d, options.bsdf));
    if (!factors.empty() && factors.back().second == Vec3(0)) return Vec3(0);
    hit = bvh.next(ray, *hit);
    ++beyond;
  }
  // In the order of PassedTriangles.
  std::ranges::sort(factors, {}, &std::pair<PrimitiveId, Vec3>::first);
  Vec3 product(1);
  for (const auto& [id, factor] : factors) product *= factor;
  return product;
}

}  // namespace microtrace
