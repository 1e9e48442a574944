#include "render/integrators/shadow_rays.hpp"

#include "render/shading/transmittance.hpp"

#include <new>

namespace microtrace {

void ShadowRays::add(const Shadow& shadow, const Vec3& origin, const Vec3& direction,
                     PrimitiveId surface) {
  Group& group = shadow.target ? aimed_ : free_;
  // Creates the ray in place, because copying a struct that was just written in parts is slow.
  ::new (&group.rays[group.count])
      Ray{.o = origin, .t_min = 0, .d = direction, .t_max = shadow.t_max};
  group.finish(shadow, surface);
}

void ShadowRays::Group::finish(const Shadow& shadow, PrimitiveId surface) {
  light[count] = shadow.color;
  slots[count] = shadow.slot;
  targets[count] = shadow.target;
  left[count++] = surface;
}

std::uint64_t ShadowRays::pass_layers(const Bvh& bvh, const Shading& shading, bool passes_backs,
                                      Group& group, std::span<Vec3> colors) {
  std::uint64_t beyond = 0;
  bvh.intersect(std::span(group.rays).first(group.count), std::span(hits_).first(group.count),
                std::span(group.left).first(group.count));
  for (std::size_t i = 0; i < group.count; ++i) {
    colors[group.slots[i]] += transmittance(bvh, shading, passes_backs, group.rays[i], hits_[i],
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
  bvh.occluded(std::span(free_.rays).first(free_.count), std::span(occluded).first(free_.count),
               std::span(free_.left).first(free_.count));
  for (std::size_t i = 0; i < free_.count; ++i) {
    if (!occluded[i]) {
      colors[free_.slots[i]] += free_.light[i];
    } else if (!shading.all_cover() || (passes_backs && shading.has_open_backs())) {
      met_.rays[met_.count] = free_.rays[i];
      met_.finish({.color = free_.light[i], .t_max = 0, .slot = free_.slots[i], .target = {}},
                  free_.left[i]);
    }
  }
  free_.count = 0;
  const std::uint64_t beyond = pass_layers(bvh, shading, passes_backs, met_, colors);
  return beyond + pass_layers(bvh, shading, passes_backs, aimed_, colors);
}

}  // namespace microtrace
