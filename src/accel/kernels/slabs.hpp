#pragma once
/// Computes the factors of a ray that give the distances to the planes of boxes. Margins make the
/// box test conservative: it never misses a box that the ray touches in real arithmetic. After T.
/// Ize, "Robust BVH Ray Traversal", JCGT 2013, whose margin of 2 ulps is insufficient if d is
/// subnormal.
///
/// q = fl(1 / |d|) is within (1 +- u) / |d|. The near factor is two ulps less than q, at most (1 -
/// u) / |d|. Because fl(x) <= x (1 + u), fl(fl(lo - o) * near) is at most the exact distance if lo
/// >= o. If lo < o, it is negative, and t_min >= 0 replaces it. The far factor is three ulps more
/// than q, at least (1 + u)^2 / |d|, which is sufficient for the far side. If q overflows, the near
/// factor is the largest float and the far factor is infinite; 0 * infinity is NaN, which means no
/// limit.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

/// Computes the near and far factors for the lanes of d, with the sign of d; d = 0 counts as
/// positive.
template <int N>
inline void slab_factors(const Float<N>& d, Float<N>& near, Float<N>& far) {
  using F = Float<N>;
  const F zero{}, largest = all<N>(__FLT_MAX__);
  const F q = 1 / magnitude(d);
  const F capped = lesser(q, largest);
  const F below = moved_by_ulps<N>(capped, -2);
  // Adding several ulps to FLT_MAX would go past infinity and give NaN; one ulp gives infinity.
  const F above = q < all<N>(0x1p127F) ? moved_by_ulps<N>(capped, 3) : all<N>(__builtin_inff());
  near = d < zero ? -below : below;
  far = d < zero ? -above : above;
}

inline void find_planes(const float (&d)[3], BoxRay& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto lo = static_cast<std::uint32_t>(axis * kWidth), hi = lo + 3 * kWidth;
    const bool negative = d[axis] < 0;
    box.near_plane[axis] = negative ? hi : lo;
    box.far_plane[axis] = negative ? lo : hi;
  }
}

/// Computes the factors and planes for a direction. Returns |d_x| + |d_y| + |d_z|, rounded up.
inline float set_direction(const float (&direction)[3], BoxRay& box) {
  float d[4] = {direction[0], direction[1], direction[2], 0}, near[4], far[4];
  Float<4> near_factor, far_factor;
  slab_factors<4>(load<4>(d), near_factor, far_factor);
  store<4>(near, near_factor);
  store<4>(far, far_factor);
  float sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    box.near_factor[axis] = near[axis];
    box.far_factor[axis] = far[axis];
    sum += __builtin_fabsf(d[axis]);
  }
  find_planes(direction, box);
  // The sum and the product have three roundings, so half of the margin would suffice. This and
  // other factors near 1 in the kernels omit terms of order u^2, which the .01 in bounds such as
  // 15.01 u covers.
  return sum * (1 + 0x1p-21F);
}

inline void set_origin(const float (&o)[3], BoxRay& box) {
  for (int axis = 0; axis < 3; ++axis) box.near_o[axis] = box.far_o[axis] = o[axis];
}

/// Computes the members that the kernel sets.
inline void prepare_ray(KernelRay& ray) {
  set_origin(ray.o, ray.box);
  ray.d_sum = set_direction(ray.d, ray.box);
}

}  // namespace
}  // namespace microtrace
