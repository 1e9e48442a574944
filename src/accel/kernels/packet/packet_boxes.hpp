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

inline void set_all_common(FactorBounds& bounds) {
  bounds.all_common = bounds.common_sign[0] && bounds.common_sign[1] && bounds.common_sign[2];
}

/// Computes bounds of the slab factors of all rays, which decrease as |d| increases. The first
/// three lanes bound the directions.
inline void bound_factors(const Float<4>& least, const Float<4>& greatest, FactorBounds& bounds) {
  const Float<4> d[2] = {least, greatest};
  float near[2][4], far[2][4];
  for (int i = 0; i < 2; ++i) {
    Float<4> near_factors, far_factors;
    slab_factors<4>(d[i], near_factors, far_factors);
    store<4>(near[i], near_factors);
    store<4>(far[i], far_factors);
  }
  for (int axis = 0; axis < 3; ++axis) {
    bounds.negative[axis] = d[1][axis] < 0;
    bounds.common_sign[axis] = (d[1][axis] < 0 || d[0][axis] >= 0) &&
                               __builtin_fabsf(far[0][axis]) <= __FLT_MAX__ &&
                               __builtin_fabsf(far[1][axis]) <= __FLT_MAX__;
    bounds.least_near[axis] = near[1][axis];
    bounds.greatest_near[axis] = near[0][axis];
    bounds.least_far[axis] = far[1][axis];
    bounds.greatest_far[axis] = far[0][axis];
  }
  set_all_common(bounds);
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
  set_all_common(bounds);
}

/// Sets the rays of some groups inside an instance, see InnerRay. Returns false if they exceed the
/// limits.
template <int N>
inline bool enter(const Instance& instance, const KernelPacket& packet, Groups groups,
                  PacketBoxRays& boxes) {
  using F = Float<N>;
  const InnerOrigin origin(instance, packet.o);
  float least_d[4] = {}, greatest_d[4] = {};
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
  bound_factors(load<4>(least_d), load<4>(greatest_d), boxes.bounds);
  return suits;
}

/// The children of a node that rays with a common origin may enter within [begin, limit].
template <int N>
struct BeamTest {
  Lanes entered = 0;
  alignas(64) float near[kWidth];  ///< lower bounds of the parameters at which rays enter
  /// The planes, relative to the origin, through which the rays enter and leave; only for axes with
  /// common_sign.
  float enter[3][kWidth], leave[3][kWidth];

  BeamTest(const WideNode& node, const PacketBoxRays& rays, const FactorBounds& bounds, float begin,
           float limit) {
    using F = Float<N>;
    const float* const lo[3] = {node.lo_x, node.lo_y, node.lo_z};
    const float* const hi[3] = {node.hi_x, node.hi_y, node.hi_z};
    for (int i = 0; i < kWidth; i += N) {
      F first = all<N>(begin), last = all<N>(limit);
      for (int axis = 0; axis < 3; ++axis) {
        if (!bounds.common_sign[axis]) continue;
        const bool negative = bounds.negative[axis];
        const F to_lo = load<N>(lo[axis] + i) - rays.o_of_lo[axis];
        const F to_hi = load<N>(hi[axis] + i) - rays.o_of_hi[axis];
        const F in = negative ? to_hi : to_lo, out = negative ? to_lo : to_hi;
        first =
            greater(lesser(in * bounds.least_near[axis], in * bounds.greatest_near[axis]), first);
        last = lesser(greater(out * bounds.least_far[axis], out * bounds.greatest_far[axis]), last);
        store<N>(enter[axis] + i, in);
        store<N>(leave[axis] + i, out);
      }
      entered |= less_equal<N>(first, last) << i;
      store<N>(near + i, first);
    }
  }
};

/// True if a ray of a group enters a child. FactorBounds::all_common is set for the group.
template <int N, int M>
inline bool enters_in_order(const KernelPacket& packet, const PacketBoxRays& rays,
                            const BeamTest<M>& beam, int lane, int group) {
  using F = Float<N>;
  const int first = group * kGroupRays;
  for (int i = first; i < first + kGroupRays; i += N) {
    F enter = load<N>(packet.t_begin + i), leave = load<N>(packet.best_hi + i);
    for (int axis = 0; axis < 3; ++axis) {
      enter = greater(load<N>(rays.near[axis] + i) * beam.enter[axis][lane], enter);
      leave = lesser(load<N>(rays.far[axis] + i) * beam.leave[axis][lane], leave);
    }
    if (less_equal<N>(enter, leave) != 0) return true;
  }
  return false;
}

/// Does the same for any rays. The sign of each ray's factor decides which plane the ray meets
/// first.
template <int N>
inline bool enters(const KernelPacket& packet, const PacketBoxRays& rays, const WideNode& node,
                   int lane, int group) {
  using F = Float<N>;
  const float lo[3] = {node.lo_x[lane], node.lo_y[lane], node.lo_z[lane]};
  const float hi[3] = {node.hi_x[lane], node.hi_y[lane], node.hi_z[lane]};
  const int first = group * kGroupRays;
  for (int i = first; i < first + kGroupRays; i += N) {
    F enter = load<N>(packet.t_begin + i), leave = load<N>(packet.best_hi + i);
    for (int axis = 0; axis < 3; ++axis) {
      const F near_factor = load<N>(rays.near[axis] + i), far_factor = load<N>(rays.far[axis] + i);
      const F zero{};
      const F to_lo = all<N>(lo[axis] - rays.o_of_lo[axis]);
      const F to_hi = all<N>(hi[axis] - rays.o_of_hi[axis]);
      enter = greater(near_factor * (near_factor < zero ? to_hi : to_lo), enter);
      leave = lesser(far_factor * (far_factor < zero ? to_lo : to_hi), leave);
    }
    if (less_equal<N>(enter, leave) != 0) return true;
  }
  return false;
}

}  // namespace
}  // namespace microtrace
