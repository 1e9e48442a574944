#pragma once
/// Traverses the tree with one ray, nearest children first.

#include "accel/kernels/block_test.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/node_test.hpp"
#include "accel/kernels/slabs.hpp"

namespace microtrace {
namespace {

struct StackEntry {
  ChildRef child;
  float near;
};

template <int N, bool kAny>
inline void walk(const TreeView& tree, KernelRay& ray, const Fallback& slow, ClosestSoFar& best) {
  prepare_ray(ray);
  const auto fallback = [&](std::uint32_t id, ClosestSoFar& b) {
    slow.consider(slow.context, id, b);
  };
  RayStack stack;
  stack.clear();
  for (ChildRef next = tree.root; next != kFinished;) {
    if ((next & child_ref::kKind) == 0) {
      next = step_into<N, kAny>(tree.nodes[next], ray, best.hi, stack);
    } else {
      meet_leaf<N, kAny>(tree, ray, next, best, fallback);
      if (kAny && best.id != kNoPrimitive) return;
      next = pop<kAny>(stack, best.hi);
    }
  }
}

template <int N>
void closest(const TreeView& tree, KernelRay ray, const Fallback& slow, ClosestSoFar& best) {
  walk<N, false>(tree, ray, slow, best);
}

template <int N>
bool any(const TreeView& tree, KernelRay ray, const Fallback& slow) {
  ClosestSoFar best{ray.t_max, ray.t_max, kNoPrimitive};
  walk<N, true>(tree, ray, slow, best);
  return best.id != kNoPrimitive;
}

}  // namespace
}  // namespace microtrace
