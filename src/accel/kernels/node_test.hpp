#pragma once
/// The children of a node that a ray enters, and the stack on which they wait.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"
#include "accel/kernels/slabs.hpp"

namespace microtrace {
namespace {

constexpr int kStackSize = 64 * (kWidth - 1) + 1;  // the builder keeps trees below 64 levels

/// Subtrees yet to visit, with the distance at which the ray enters them.
struct RayStack {
  int size = 0;
  ChildRef child[kStackSize + kWidth];  // writing a node's children overwrites kWidth places
  float near[kStackSize + kWidth];
};

/// Of eight children those that the ray enters before `limit`, and where.
template <int N>
struct NodeTest {
  Lanes entered = 0;
  alignas(32) float near[kWidth];

  NodeTest(const WideNode& node, const KernelRay& ray, float limit) {
    using F = Float<N>;
    const float* planes = node.lo_x;  // all six arrays lie one after another
    for (int i = 0; i < kWidth; i += N) {
      const auto distance = [&](const std::uint32_t(&plane)[3], const float(&factor)[3], int axis) {
        return (load<N>(planes + plane[axis] + i) - ray.o[axis]) * factor[axis];
      };
      const F near_x = distance(ray.near_plane, ray.near_factor, 0);
      const F near_y = distance(ray.near_plane, ray.near_factor, 1);
      const F near_z = distance(ray.near_plane, ray.near_factor, 2);
      const F far_x = distance(ray.far_plane, ray.far_factor, 0);
      const F far_y = distance(ray.far_plane, ray.far_factor, 1);
      const F far_z = distance(ray.far_plane, ray.far_factor, 2);
      // 0 * infinity is NaN, and means no limit: lesser and greater drop a NaN on their left.
      const F enter = greater(near_x, greater(near_y, greater(near_z, all<N>(ray.t_begin))));
      const F leave = lesser(far_x, lesser(far_y, lesser(far_z, all<N>(limit))));
      entered |= less_equal<N>(enter, leave) << i;
      store<N>(near + i, enter);
    }
  }
};

/// Pushes the children that the ray enters before `limit`: the nearest last, or with kAny in any
/// order and without their distance.
template <int N, bool kAny>
inline void push_children(const WideNode& node, const KernelRay& ray, float limit,
                          RayStack& stack) {
  const NodeTest<N> test(node, ray, limit);
  if constexpr (kAny)
    store_lanes(test.entered, node.child, stack.child + stack.size);
  else
    store_descending(test.entered, test.near, node.child, stack.near + stack.size,
                     stack.child + stack.size);
  stack.size += __builtin_popcount(test.entered);
}

}  // namespace
}  // namespace microtrace
