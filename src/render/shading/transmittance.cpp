#include "render/shading/transmittance.hpp"

namespace microtrace {

float transmittance(const Bvh& bvh, const Shading& shading, bool passes_backs, const Ray& ray,
                    std::optional<Hit> hit, const std::optional<PrimitiveId>& target,
                    std::uint64_t& beyond) {
  float transmittance = 1;
  while (hit && hit->id != target) {
    const ShadingPoint point = shading.point(ray, *hit);
    // If the ray hits a front, the light comes from behind it.
    if (!(passes_backs && Shading::lets_light_in(point)))
      transmittance *= 1 - shading.coverage(point, false);
    if (transmittance == 0) return 0;
    hit = bvh.next(ray, *hit);
    ++beyond;
  }
  return hit || !target ? transmittance : 0;
}

}  // namespace microtrace
