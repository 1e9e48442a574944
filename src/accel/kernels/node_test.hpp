#pragma once
/// Finds the children of a node that a ray enters, and stores them on a stack.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"
#include "accel/kernels/slabs.hpp"
#include "simd/lane_count.hpp"

namespace microtrace {
namespace {

/// The greatest number of subtrees on a stack. The builder limits the depth of trees to 64. A
/// mesh's tree may be below a tree of instances.
constexpr int stack_size(bool has_instances) {
  return (has_instances ? 2 : 1) * 64 * (kWidth - 1) + 2;
}
constexpr int kStackSize = stack_size(true);

/// Marks the end of the stack.
constexpr ChildRef kFinished = child_ref::kKind;
using child_ref::kInstanceEnd;

/// The subtrees that are still to be visited, each with the distance at which the ray enters it.
/// kFinished is at the bottom.
template <bool kInstances>
struct RayStack {
  // Storing a node's children may overwrite up to kWidth slots above the top.
  static constexpr int kSlots = stack_size(kInstances) + kWidth;

  int size;
  ChildRef child[kSlots];
  float near[kSlots];

  void clear() {
    size = 1;
    child[0] = kFinished;
    near[0] = -__builtin_inff();
  }
  void push_instance_end() {
    child[size] = kInstanceEnd;
    near[size++] = -__builtin_inff();
  }
};

/// Pops the subtree that was pushed last. Without kAny, skips subtrees that start beyond the limit.
template <bool kAny, bool kInstances>
inline ChildRef pop(RayStack<kInstances>& stack, float limit) {
  int top = stack.size - 1;
  if constexpr (!kAny) {
    while (stack.near[top] > limit) --top;
  }
  stack.size = top;
  return stack.child[top];
}

/// The children of a node that the ray enters before `limit`, and the entry distances. With
/// kOneOrigin, the ray's near_o and far_o are equal.
template <int N, bool kOneOrigin>
struct NodeTest {
  Lanes entered = 0;
  alignas(32) float near[kWidth];

  NodeTest(const WideNode& node, const BoxRay& ray, float begin, float limit) {
    using F = Float<N>;
    const float* planes = node.lo_x;  // the node's six arrays are consecutive in memory
    for (int i = 0; i < kWidth; i += N) {
      const auto near_at = [&](int axis) {
        return (load<N>(planes + ray.near_plane[axis] + i) - ray.near_o[axis]) *
               ray.near_factor[axis];
      };
      const auto far_at = [&](int axis) {
        return (load<N>(planes + ray.far_plane[axis] + i) -
                (kOneOrigin ? ray.near_o : ray.far_o)[axis]) *
               ray.far_factor[axis];
      };
      const F near_x = near_at(0), near_y = near_at(1), near_z = near_at(2);
      const F far_x = far_at(0), far_y = far_at(1), far_z = far_at(2);
      // 0 * infinity is NaN, which means that the plane is no limit: lesser and greater ignore a
      // NaN in their first argument.
      const F enter = greater(near_x, greater(near_y, greater(near_z, all<N>(begin))));
      const F leave = lesser(far_x, lesser(far_y, lesser(far_z, all<N>(limit))));
      entered |= less_equal<N>(enter, leave) << i;
      store<N>(near + i, enter);
    }
  }
};

/// Tests the children of a node. Returns the nearest child that the ray enters before `limit` and
/// pushes the other entered children. With kAny, returns any entered child and pushes the others
/// without their distances. If the ray enters none, pops a subtree: with kAny the top one,
/// otherwise the first that starts before the limit.
template <int N, bool kAny, bool kInstances>
inline ChildRef step_into(const WideNode& node, const BoxRay& ray, float begin, float limit,
                          RayStack<kInstances>& stack) {
  const NodeTest<N, !kInstances> test(node, ray, begin, limit);
  // The ninth bit gives first_lane a defined result if no child is entered.
  const int lane =
      kAny ? first_lane(test.entered | 0x100U) & 7 : least_lane(test.entered, test.near);
  const Lanes others = test.entered & ~(Lanes{1} << lane);
  const int size = stack.size;
  const ChildRef popped = stack.child[size - 1];
  const float popped_near = kAny ? 0 : stack.near[size - 1];
  store_lanes(others, node.child, stack.child + size);
  if constexpr (!kAny) store_lanes(others, test.near, stack.near + size);
  stack.size = size - 1 + lane_count(test.entered);
  const bool pops = test.entered == 0;
  if (!kAny && pops & (popped_near > limit)) return pop<kAny>(stack, limit);
  return pops ? popped : node.child[lane];
}

}  // namespace
}  // namespace microtrace
