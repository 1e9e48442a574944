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

template <int N, bool kAny, class Slowly>
inline void walk(const TreeView& tree, KernelRay& ray, const Slowly& fallback, ClosestSoFar& best) {
  prepare_ray(ray);
  Scope scope(tree);
  InnerRay inner;
  RayStack<true> stack;
  stack.clear();
  for (ChildRef next = tree.root; next != kFinished;) {
    if ((next & child_ref::kKind) == 0) {
      next = step_into<N, kAny>(scope.nodes[next], scope.choose(ray.box, inner.box), ray.t_begin,
                                best.hi, stack);
      continue;
    }
    if (next == kInstanceEnd) {
      scope = Scope(tree);
    } else if (is_instance(next)) {
      const Instance& instance = tree.instances[next - child_ref::kFirstInstance];
      if (enter(instance, ray, inner)) {
        const MeshTree& mesh = tree.meshes[instance.mesh];
        scope = Scope(mesh, instance);
        stack.push_instance_end();
        next = mesh.root;
        continue;
      }
      consider_instance(tree, instance, ray, best, fallback);
    } else {
      meet_leaf<N, kAny>(tree, scope, ray, inner, next, best, fallback);
    }
    if (kAny && best.id != kNoPrimitive) return;
    next = pop<kAny>(stack, best.hi);
  }
}

template <int N>
void closest(const TreeView& tree, KernelRay ray, const Fallback& slow, ClosestSoFar& best) {
  walk<N, false>(tree, ray, RayFallback{slow}, best);
}

template <int N>
bool any(const TreeView& tree, KernelRay ray, const Fallback& slow) {
  ClosestSoFar best{ray.t_max, ray.t_max, kNoPrimitive};
  walk<N, true>(tree, ray, RayFallback{slow}, best);
  return best.id != kNoPrimitive;
}

}  // namespace
}  // namespace microtrace
