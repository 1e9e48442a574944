#include "render/integrators/shadow_rays.hpp"

#include <limits>

namespace microtrace {

void ShadowRays::add(const Vec3& origin, const LightSample& light, const Vec3& color,
                     std::size_t slot) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  // A punctual light is at t = 1; an emissive triangle is hit approximately there.
  const float t_max = light.is_far || light.target ? kInfinity : 1;
  Group& group = light.target ? aimed_ : free_;
  group.add({.o = origin, .t_min = 0, .d = light.to_light, .t_max = t_max}, color, slot,
            light.target);
}

void ShadowRays::Group::add(const Ray& ray, const Vec3& color, std::size_t slot,
                            const std::optional<PrimitiveId>& target) {
  rays[count] = ray;
  light[count] = color;
  slots[count] = slot;
  targets[count++] = target;
}

namespace {

/// The fraction of the light that passes all surfaces before t_max or the target; `beyond` counts
/// the calls of Bvh::next.
float transmittance(const Bvh& bvh, const Shading& shading, bool passes_backs, const Ray& ray,
                    std::optional<Hit> hit, const std::optional<PrimitiveId>& target,
                    std::uint64_t& beyond) {
  float transmittance = 1;
  while (hit && hit->id != target) {
    const ShadingPoint point = shading.point(ray, *hit);
    // A front that the ray hits is hit from behind by the light.
    if (!(passes_backs && Shading::lets_light_in(point)))
      transmittance *= 1 - shading.coverage(point, false);
    if (transmittance == 0) return 0;
    hit = bvh.next(ray, *hit);
    ++beyond;
  }
  return hit || !target ? transmittance : 0;
}

}  // namespace

std::uint64_t ShadowRays::pass_layers(const Bvh& bvh, const Shading& shading, bool passes_backs,
                                      Group& group, std::span<Vec3> colors) {
  std::uint64_t beyond = 0;
  std::array<std::optional<Hit>, kRandomBatch> hits;
  bvh.intersect(std::span(group.rays).first(group.count), std::span(hits).first(group.count));
  for (std::size_t i = 0; i < group.count; ++i) {
    colors[group.slots[i]] += transmittance(bvh, shading, passes_backs, group.rays[i], hits[i],
                                            group.targets[i], beyond) *
                              group.light[i];
  }
  group.count = 0;
  return beyond;
}

std::uint64_t ShadowRays::trace(const Bvh& bvh, const Shading& shading, Backfaces backfaces,
                                std::span<Vec3> colors) {
  const bool passes_backs = backfaces == Backfaces::pass;
  std::array<bool, kRandomBatch> occluded;
  bvh.occluded(std::span(free_.rays).first(free_.count), std::span(occluded).first(free_.count));
  for (std::size_t i = 0; i < free_.count; ++i) {
    if (!occluded[i]) {
      colors[free_.slots[i]] += free_.light[i];
    } else if (!shading.all_cover() || (passes_backs && shading.has_open_backs())) {
      met_.add(free_.rays[i], free_.light[i], free_.slots[i], free_.targets[i]);
    }
  }
  free_.count = 0;
  const std::uint64_t beyond = pass_layers(bvh, shading, passes_backs, met_, colors);
  return beyond + pass_layers(bvh, shading, passes_backs, aimed_, colors);
}

}  // namespace microtrace
