#pragma once
/// The rays of a packet for tests of boxes, in the scene and in the space of an instance's mesh.

#include "accel/kernels/inner_ray.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"
#include "accel/kernels/slabs.hpp"

namespace microtrace {
namespace {

/// A set of groups of a packet's rays, one bit each.
using Groups = Lanes;
inline constexpr Groups kAllGroups = (Groups{1} << kGroups) - 1;

/// Calls f(group) for each group.
template <class F>
inline void for_each_group(Groups groups, const F& f) {
  for (; groups != 0; groups &= groups - 1) f(first_lane(groups));
}

/// Computes bounds of the slab factors of all rays, which decrease as |d| increases.
inline void bound_factors(const float (&least)[3], const float (&greatest)[3],
                          FactorBounds& bounds) {
  const float d[8] = {least[0], least[1], least[2], 0, greatest[0], greatest[1], greatest[2], 0};
  float near[8], far[8];
  for (int i = 0; i < 8; i += 4) {
    Float<4> near_factors, far_factors;
    slab_factors<4>(load<4>(d + i), near_factors, far_factors);
    store<4>(near + i, near_factors);
    store<4>(far + i, far_factors);
  }
  for (int axis = 0; axis < 3; ++axis) {
    bounds.negative[axis] = greatest[axis] < 0;
    bounds.common_sign[axis] = (greatest[axis] < 0 || least[axis] >= 0) &&
                               __builtin_fabsf(far[axis]) <= __FLT_MAX__ &&
                               __builtin_fabsf(far[axis + 4]) <= __FLT_MAX__;
    bounds.least_near[axis] = near[axis + 4];
    bounds.greatest_near[axis] = near[axis];
    bounds.least_far[axis] = far[axis + 4];
    bounds.greatest_far[axis] = far[axis];
  }
}

/// Computes the same bounds for the rays of one group.
template <int N>
inline void bound_factors(const PacketBoxRays& rays, int group, FactorBounds& bounds) {
  using F = Float<N>;
  const int first = group * kGroupRays;
  for (int axis = 0; axis < 3; ++axis) {
    F least_near = load<N>(rays.near[axis] + first), greatest_near = least_near;
    F least_far = load<N>(rays.far[axis] + first), greatest_far = least_far;
    for (int i = first + N; i < first + kGroupRays; i += N) {
      const F near = load<N>(rays.near[axis] + i), far = load<N>(rays.far[axis] + i);
      least_near = lesser(near, least_near), greatest_near = greater(near, greatest_near);
      least_far = lesser(far, least_far), greatest_far = greater(far, greatest_far);
    }
    bounds.least_near[axis] = least_of<N>(least_near);
    bounds.greatest_near[axis] = greatest_of<N>(greatest_near);
    bounds.least_far[axis] = least_of<N>(least_far);
    bounds.greatest_far[axis] = greatest_of<N>(greatest_far);
    // The factors have the sign of d, and those of d = 0 are positive.
    bounds.negative[axis] = bounds.greatest_near[axis] < 0;
    bounds.common_sign[axis] = (bounds.negative[axis] || bounds.least_near[axis] > 0) &&
                               bounds.least_far[axis] >= -__FLT_MAX__ &&
                               bounds.greatest_far[axis] <= __FLT_MAX__;
  }
}

/// Sets the rays of some groups inside an instance, see InnerRay. Returns false if they exceed the
/// limits.
template <int N>
inline bool enter(const Instance& instance, const KernelPacket& packet, Groups groups,
                  PacketBoxRays& boxes) {
  using F = Float<N>;
  const InnerOrigin origin(instance, packet.o);
  float least_d[3], greatest_d[3];
  bool suits = true;
  for (int axis = 0; axis < 3; ++axis) {
    const float(&row)[3] = instance.mesh_from_scene[axis];
    F least = all<N>(__builtin_inff()), greatest = -least;
    for_each_group(groups, [&](int group) {
      const int first = group * kGroupRays;
      for (int i = first; i < first + kGroupRays; i += N) {
        const F d = row[0] * load<N>(packet.d[0] + i) + row[1] * load<N>(packet.d[1] + i) +
                    row[2] * load<N>(packet.d[2] + i);
        F near, far;
        slab_factors<N>(d, near, far);
        store<N>(boxes.near[axis] + i, near);
        store<N>(boxes.far[axis] + i, far);
        least = lesser(d, least);
        greatest = greater(d, greatest);
      }
    });
    least_d[axis] = least_of<N>(least);
    greatest_d[axis] = greatest_of<N>(greatest);
    boxes.o_of_lo[axis] = origin.o[axis] + origin.reach[axis];
    boxes.o_of_hi[axis] = origin.o[axis] - origin.reach[axis];
    suits &= __builtin_fabsf(origin.o[axis]) <= kFarthestCoordinate &&
             -kLongestInnerDirection <= least_d[axis] && greatest_d[axis] <= kLongestInnerDirection;
  }
  bound_factors(least_d, greatest_d, boxes.bounds);
  return suits;
}

/// The box of a node's child relative to the origin of a packet's rays.
struct SeenBox {
  float lo[3], hi[3];

  SeenBox(const PacketBoxRays& rays, const WideNode& node, int lane)
      : lo{node.lo_x[lane] - rays.o_of_lo[0], node.lo_y[lane] - rays.o_of_lo[1],
           node.lo_z[lane] - rays.o_of_lo[2]},
        hi{node.hi_x[lane] - rays.o_of_hi[0], node.hi_y[lane] - rays.o_of_hi[1],
           node.hi_z[lane] - rays.o_of_hi[2]} {}

  /// True if a ray of a group enters the box. `bounds` are valid for the group.
  template <int N>
  [[nodiscard]] bool is_entered(const KernelPacket& packet, const PacketBoxRays& rays,
                                const FactorBounds& bounds, int group) const {
    using F = Float<N>;
    const int first = group * kGroupRays;
    for (int i = first; i < first + kGroupRays; i += N) {
      F enter = load<N>(packet.t_begin + i), leave = load<N>(packet.best_hi + i);
      for (int axis = 0; axis < 3; ++axis) {
        const F near_factor = load<N>(rays.near[axis] + i),
                far_factor = load<N>(rays.far[axis] + i);
        if (bounds.common_sign[axis]) {
          const bool negative = bounds.negative[axis];
          enter = greater(near_factor * (negative ? hi[axis] : lo[axis]), enter);
          leave = lesser(far_factor * (negative ? lo[axis] : hi[axis]), leave);
        } else {
          // The sign of each ray's factor decides which plane the ray meets first.
          const F zero{};
          const F l = all<N>(lo[axis]), h = all<N>(hi[axis]);
          enter = greater(near_factor * (near_factor < zero ? h : l), enter);
          leave = lesser(far_factor * (far_factor < zero ? l : h), leave);
        }
      }
      if (less_equal<N>(enter, leave) != 0) return true;
    }
    return false;
  }
};

}  // namespace
}  // namespace microtrace
