#include "render/lighting/ground_shadows.hpp"

#include "render/shading/transmittance.hpp"
#include "scene/math/luminance.hpp"

#include <cmath>
#include <limits>
#include <new>

namespace microtrace {

std::optional<Vec3> point_on_ground(const Ray& ray, float height) {
  if (!(ray.d.y < 0) || !(ray.o.y > height)) return std::nullopt;
  const double t = (double{height} - double{ray.o.y}) / double{ray.d.y};
  if (!(t >= double{ray.t_min}) || !(t <= double{ray.t_max})) return std::nullopt;
  const Vec3 p(DVec3(ray.o) + t * DVec3(ray.d));
  if (!std::isfinite(p.x) || !std::isfinite(p.z)) return std::nullopt;
  return Vec3(p.x, height, p.z);
}

void GroundShadows::add(const Vec3& p, const Vec3& to_light, bool is_far, std::size_t slot) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  ::new (&rays_[count_]) Ray{.o = p, .t_min = 0, .d = to_light, .t_max = is_far ? kInfinity : 1};
  slots_[count_++] = slot;
}

std::uint64_t GroundShadows::find_occlusions(const Bvh& bvh, const Shading& shading,
                                             const PathOptions& options) {
  const bool may_pass = !shading.all_cover() || (passes_backs(options) && shading.has_open_backs());
  std::array<bool, kRandomBatch> occluded;
  bvh.occluded(std::span(rays_).first(count_), std::span(occluded).first(count_));
  std::uint64_t beyond = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    occlusions_[i] = occluded[i] ? 1 : 0;
    if (occluded[i] && may_pass) {
      occlusions_[i] = 1 - luminance(transmittance(bvh, shading, options, rays_[i],
                                                   bvh.intersect(rays_[i]), std::nullopt, beyond));
    }
  }
  return beyond;
}

}  // namespace microtrace
