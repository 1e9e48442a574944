#include "accel/kernel_rays.hpp"

#include "accel/slow_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace microtrace {
namespace {

// False for NaN: what is within is finite.
bool within(const Vec3& v, float limit) {
  return std::abs(v.x) <= limit && std::abs(v.y) <= limit && std::abs(v.z) <= limit;
}

}  // namespace

bool suits_kernels(const Ray& ray) {
  return within(ray.o, kFarthestCoordinate) && within(ray.d, kLongestDirection) &&
         (std::abs(ray.d.x) >= kShortestDirection || std::abs(ray.d.y) >= kShortestDirection ||
          std::abs(ray.d.z) >= kShortestDirection) &&
         ray.t_min >= 0 && ray.t_min <= kFarthestCoordinate && ray.t_min <= ray.t_max;
}

KernelRay kernel_ray(const Ray& ray) {
  KernelRay k{};
  for (int axis = 0; axis < 3; ++axis) {
    k.o[axis] = ray.o[axis];
    k.d[axis] = ray.d[axis];
  }
  k.t_min = ray.t_min;
  k.t_max = ray.t_max;
  k.t_begin = ray.t_min < kLeastBegin ? 0 : ray.t_min;
  return k;
}

KernelRay kernel_ray_from(const Ray& ray, const exact::Enclosure& begin) {
  KernelRay k = kernel_ray(ray);
  const Best bounds = outwards(begin.lo, begin.hi, 0);
  k.t_min = std::nextafter(bounds.hi, std::numeric_limits<float>::infinity());
  const float least = std::min(bounds.lo, kFarthestCoordinate);
  k.t_begin = std::max(k.t_begin, least < kLeastBegin ? 0 : least);
  return k;
}

bool fill_tile(std::span<const Ray> rays, const Kernels& kernels, KernelTile& tile) {
  const auto fill = [&](std::size_t i, const Ray& ray) {
    tile.d_x[i] = ray.d.x;
    tile.d_y[i] = ray.d.y;
    tile.d_z[i] = ray.d.z;
    tile.t_min[i] = ray.t_min;
    tile.best_lo[i] = tile.best_hi[i] = ray.t_max;
    tile.best_id[i] = kNoPrimitive;
  };
  for (std::size_t i = 0; i < rays.size(); ++i) fill(i, rays[i]);
  for (std::size_t i = rays.size(); i < kTileRays; ++i) fill(i, rays.back());
  for (int axis = 0; axis < 3; ++axis) tile.o[axis] = rays[0].o[axis];
  std::fill_n(tile.o_x, kTileRays, tile.o[0]);
  std::fill_n(tile.o_y, kTileRays, tile.o[1]);
  std::fill_n(tile.o_z, kTileRays, tile.o[2]);
  tile.count = static_cast<int>(rays.size());
  return within(rays[0].o, kFarthestCoordinate) && kernels.prepare_tile(tile);
}

}  // namespace microtrace
