#include "accel/kernel_rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace microtrace {

bool suits_kernels(const Ray& ray) {
  constexpr float kFar = 0x1p38F, kLong = 0x1p20F, kShort = 0x1p-20F;
  const auto within = [](const Vec3& v, float limit) {
    return std::abs(v.x) <= limit && std::abs(v.y) <= limit && std::abs(v.z) <= limit;
  };
  // Comparisons are false for NaN, so that what passes is finite.
  return within(ray.o, kFar) && within(ray.d, kLong) && !(within(ray.d, kShort)) &&
         ray.t_min >= 0 && ray.t_min <= kFar && ray.t_min <= ray.t_max;
}

KernelRay kernel_ray(const Ray& ray) {
  KernelRay k{};
  for (int axis = 0; axis < 3; ++axis) {
    k.o[axis] = ray.o[axis];
    k.d[axis] = ray.d[axis];
  }
  k.t_min = ray.t_min;
  k.t_max = ray.t_max;
  return k;
}

void fill_tile(std::span<const Ray> rays, KernelTile& tile) {
  for (int axis = 0; axis < 3; ++axis) tile.o[axis] = rays[0].o[axis];
  const auto fill = [&](std::size_t i, const Ray& ray) {
    tile.d_x[i] = ray.d.x;
    tile.d_y[i] = ray.d.y;
    tile.d_z[i] = ray.d.z;
    tile.t_min[i] = ray.t_min;
  };
  for (std::size_t i = 0; i < rays.size(); ++i) fill(i, rays[i]);
  for (std::size_t i = rays.size(); i < kTileRays; ++i) {
    fill(i, rays.back());
    tile.best_lo[i] = tile.best_hi[i] = -std::numeric_limits<float>::infinity();
    tile.best_id[i] = kNoPrimitive;
  }
}

}  // namespace microtrace
