#include "accel/kernel_rays.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace microtrace {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kMax = std::numeric_limits<float>::max();

float moved(float x, int ulps) {
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) + static_cast<std::uint32_t>(ulps));
}

// Factors for the distances to the planes of boxes, after Ize (Robust BVH Ray Traversal, JCGT
// 2013), with the margins that docs/exactness.md derives: q = fl(1 / |d|) is within (1 +- u) / |d|,
// so 2 ulp less is at most (1 - u) / |d|, and fl(fl(lo - o) * that) <= the exact distance; 3 ulp
// more serve the far side likewise.
struct Factors {
  float near, far;
};
Factors factors(float d) {
  const float q = 1 / std::abs(d);
  const Factors result = q <= kMax ? Factors{.near = moved(q, -2),
                                             .far = q < moved(kMax, -3) ? moved(q, 3) : kInfinity}
                                   : Factors{.near = moved(kMax, -2), .far = kInfinity};
  return d < 0 ? Factors{.near = -result.near, .far = -result.far} : result;
}

float sum_rounded_up(const Vec3& d) {
  return (std::abs(d.x) + std::abs(d.y) + std::abs(d.z)) * (1 + 0x1p-21F);
}

}  // namespace

bool suits_kernels(const Ray& ray) {
  constexpr float kFar = 0x1p38F;
  const auto largest = [](const Vec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  };
  const float d = largest(ray.d);
  return largest(ray.o) <= kFar && ray.t_min <= kFar && d >= 0x1p-20F && d <= 0x1p20F;
}

KernelRay kernel_ray(const Ray& ray) {
  KernelRay k{};
  for (int i = 0; i < 3; ++i) {
    k.o[i] = ray.o[i];
    k.d[i] = ray.d[i];
    const auto [near, far] = factors(ray.d[i]);
    k.near_factor[i] = near;
    k.far_factor[i] = far;
    k.negative[i] = ray.d[i] < 0;
  }
  k.t_min = ray.t_min;
  k.t_max = ray.t_max;
  k.d_sum = sum_rounded_up(ray.d);
  return k;
}

void fill_tile(std::span<const Ray> rays, KernelTile& tile) {
  float* const d[3] = {tile.d_x, tile.d_y, tile.d_z};
  float* const near[3] = {tile.near_x, tile.near_y, tile.near_z};
  float* const far[3] = {tile.far_x, tile.far_y, tile.far_z};
  tile.d_sum = 0;
  tile.least_t_min = kInfinity;
  for (int i = 0; i < kTileRays; ++i) {
    const bool inert = static_cast<std::size_t>(i) >= rays.size();
    const Ray& ray = inert ? rays.back() : rays[static_cast<std::size_t>(i)];
    for (int axis = 0; axis < 3; ++axis) {
      d[axis][i] = ray.d[axis];
      const auto [n, f] = factors(ray.d[axis]);
      near[axis][i] = n;
      far[axis][i] = f;
    }
    tile.t_min[i] = ray.t_min;
    tile.d_sum = std::max(tile.d_sum, sum_rounded_up(ray.d));
    tile.least_t_min = std::min(tile.least_t_min, ray.t_min);
    if (inert) {
      tile.best_lo[i] = tile.best_hi[i] = -kInfinity;
      tile.best_id[i] = kNoPrimitive;
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    tile.o[axis] = rays[0].o[axis];
    const auto [least_near, greatest_near] =
        std::minmax_element(near[axis], near[axis] + kTileRays);
    const auto [least_far, greatest_far] = std::minmax_element(far[axis], far[axis] + kTileRays);
    tile.least_near[axis] = *least_near;
    tile.greatest_near[axis] = *greatest_near;
    tile.least_far[axis] = *least_far;
    tile.greatest_far[axis] = *greatest_far;
    tile.negative[axis] = *greatest_near < 0;
    tile.common_sign[axis] = (*least_near > 0) == (*greatest_near > 0) &&
                             std::isfinite(*least_far) && std::isfinite(*greatest_far);
  }
}

}  // namespace microtrace
