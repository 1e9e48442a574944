#include "render/integrators/shadow_rays.hpp"

#include <limits>

namespace microtrace {

void ShadowRays::add(const Vec3& origin, const LightSample& light, const Vec3& color,
                     std::size_t slot) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  // A light without size stands at t = 1; a triangle that shines is met about there.
  const float t_max = light.is_far || light.target ? infinity : 1;
  rays_[count_] = {.o = origin, .t_min = 0, .d = light.way, .t_max = t_max};
  light_[count_] = color;
  slots_[count_] = slot;
  targets_[count_++] = light.target;
  any_target_ |= light.target.has_value();
}

namespace {

/// The share of the light that passes all that is before t_max or the target.
float passed(const Bvh& bvh, const Shading& shading, const Ray& ray, std::optional<Hit> hit,
             const std::optional<PrimitiveId>& target) {
  float passed = 1;
  while (hit && hit->id != target) {
    passed *= 1 - shading.coverage(shading.point(ray, *hit));
    if (passed == 0) return 0;
    hit = bvh.next(ray, *hit);
  }
  return hit || !target ? passed : 0;
}

}  // namespace

void ShadowRays::arrive(const Bvh& bvh, const Shading& shading, std::span<Vec3> colors) {
  const auto rays = std::span(rays_).first(count_);
  if (shading.all_cover() && !any_target_) {
    std::array<bool, kRandomBatch> occluded;
    bvh.occluded(rays, std::span(occluded).first(count_));
    for (std::size_t i = 0; i < count_; ++i) {
      if (!occluded[i]) colors[slots_[i]] += light_[i];
    }
  } else {
    std::array<std::optional<Hit>, kRandomBatch> hits;
    bvh.intersect(rays, std::span(hits).first(count_));
    for (std::size_t i = 0; i < count_; ++i)
      colors[slots_[i]] += passed(bvh, shading, rays[i], hits[i], targets_[i]) * light_[i];
  }
  count_ = 0;
  any_target_ = false;
}

}  // namespace microtrace
