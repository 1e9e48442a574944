#pragma once
/// Factors for the distances to the planes of boxes, with margins that make a box test safe: no box
/// is missed that the ray touches in real arithmetic. After Ize, "Robust BVH Ray Traversal", JCGT
/// 2013, whose 2 ulp are not enough where d is subnormal.
///
/// q = fl(1 / |d|) is within (1 +- u) / |d|. Two ulp less is at most (1 - u) / |d|, and fl(x) <= x
/// (1 + u), so that fl(fl(lo - o) * near) is at most the exact distance for lo >= o; where lo < o
/// it is negative, and t_min >= 0 takes its place. Three ulp more are at least (1 + u)^2 / |d|,
/// which serves the far side. Where q overflows, near is as large as a float can be but finite, and
/// far is infinite: 0 * infinity is NaN and means no limit.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

/// For the lanes of d; d = 0 counts as positive.
template <int N>
inline void slab_factors(const Float<N>& d, Float<N>& near, Float<N>& far) {
  using F = Float<N>;
  const F zero{}, largest = all<N>(__FLT_MAX__);
  const F q = 1 / magnitude(d);
  const F capped = lesser(q, largest);
  const F below = moved_by_ulps<N>(capped, -2);
  // Moving FLT_MAX up would pass infinity and give NaN; one ulp reaches it.
  const F above = q < all<N>(0x1p127F) ? moved_by_ulps<N>(capped, 3) : all<N>(__builtin_inff());
  near = d < zero ? -below : below;
  far = d < zero ? -above : above;
}

inline void find_planes(KernelRay& ray) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto lo = static_cast<std::uint32_t>(axis * kWidth), hi = lo + 3 * kWidth;
    const bool negative = ray.d[axis] < 0;
    ray.near_plane[axis] = negative ? hi : lo;
    ray.far_plane[axis] = negative ? lo : hi;
  }
}

/// Fills the lower part of a ray.
inline void prepare_ray(KernelRay& ray) {
  float d[4] = {ray.d[0], ray.d[1], ray.d[2], 0}, near[4], far[4];
  Float<4> near_factor, far_factor;
  slab_factors<4>(load<4>(d), near_factor, far_factor);
  store<4>(near, near_factor);
  store<4>(far, far_factor);
  float sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    ray.near_factor[axis] = near[axis];
    ray.far_factor[axis] = far[axis];
    sum += __builtin_fabsf(d[axis]);
  }
  ray.d_sum = sum * (1 + 0x1p-21F);
  find_planes(ray);
}

template <int N, class Combine>
inline float reduce(const float* p, const Combine& combine) {
  Float<N> v = load<N>(p);
  for (int i = N; i < kTileRays; i += N) v = combine(v, load<N>(p + i));
  float result = v[0];
  for (int i = 1; i < N; ++i) {
    const float lane = v[i];
    result = combine(result, lane);
  }
  return result;
}

template <int N>
bool prepare_tile(KernelTile& tile) {
  using F = Float<N>;
  const auto least = [](const auto& a, const auto& b) { return lesser(a, b); };
  const auto greatest = [](const auto& a, const auto& b) { return greater(a, b); };
  const float* const d[3] = {tile.d_x, tile.d_y, tile.d_z};
  const F longest = all<N>(kLongestDirection), shortest = all<N>(kShortestDirection);
  Lanes suited = all_lanes<N>;
  for (int i = 0; i < kTileRays; i += N) {
    F size{};
    for (int axis = 0; axis < 3; ++axis) {
      const F component = load<N>(d[axis] + i), length = magnitude(component);
      F near, far;
      slab_factors<N>(component, near, far);
      store<N>(tile.near[axis] + i, near);
      store<N>(tile.far[axis] + i, far);
      size = greater(length, size);
      suited &= less_equal<N>(length, longest);
    }
    const F t_min = load<N>(tile.t_min + i);
    store<N>(tile.t_begin + i, t_min < all<N>(kLeastBegin) ? F{} : t_min);
    suited &= less_equal<N>(shortest, size) & less_equal<N>(F{}, t_min) &
              less_equal<N>(t_min, all<N>(kFarthestCoordinate)) &
              less_equal<N>(t_min, load<N>(tile.best_hi + i));
  }
  if (suited != all_lanes<N>) return false;
  // Places beyond the last ray hit nothing.
  for (int i = tile.count; i < kTileRays; ++i)
    tile.best_lo[i] = tile.best_hi[i] = -__builtin_inff();
  tile.d_sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    tile.least_d[axis] = reduce<N>(d[axis], least);
    tile.greatest_d[axis] = reduce<N>(d[axis], greatest);
    tile.d_sum += greater(-tile.least_d[axis], tile.greatest_d[axis]);
  }
  tile.d_sum *= 1 + 0x1p-21F;
  tile.least_t_begin = reduce<N>(tile.t_begin, least);
  for (int axis = 0; axis < 3; ++axis) {
    tile.least_near[axis] = reduce<N>(tile.near[axis], least);
    tile.greatest_near[axis] = reduce<N>(tile.near[axis], greatest);
    tile.least_far[axis] = reduce<N>(tile.far[axis], least);
    tile.greatest_far[axis] = reduce<N>(tile.far[axis], greatest);
    tile.negative[axis] = tile.greatest_near[axis] < 0;
    tile.common_sign[axis] = (tile.least_near[axis] > 0) == (tile.greatest_near[axis] > 0) &&
                             tile.least_far[axis] >= -__FLT_MAX__ &&
                             tile.greatest_far[axis] <= __FLT_MAX__;
  }
  return true;
}

}  // namespace
}  // namespace microtrace
