#pragma once
/// Finds the primitives of a tree near a box.

#include "accel/build/tree.hpp"
#include "accel/build/wide/wide_tree.hpp"
#include "accel/instances/tree_reader.hpp"
#include "accel/layout.hpp"

#include <array>

namespace microtrace {

/// Returns true if two closed boxes have a point in common.
[[nodiscard]] inline bool overlap(const Bounds& a, const Bounds& b) {
  for (int k = 0; k < 3; ++k) {
    if (a.hi[k] < b.lo[k] || b.hi[k] < a.lo[k]) return false;
  }
  return true;
}

/// Calls f(id) for every primitive in the tree with a point in the closed box. May also call f for
/// other primitives nearby, and more than once for a primitive.
template <class F>
void for_each_touching(const Tree& tree, const Bounds& box, const F& f) {
  std::array<ChildRef, kTraversalStack> stack;
  std::size_t size = 0;
  stack[size++] = tree.root;
  TreeReader reader(tree);
  while (size > 0) {
    ChildRef next = stack[--size];
    if (reader.leave(next)) continue;
    if (reader.enter(next)) stack[size++] = child_ref::kInstanceEnd;
    if (build::kind_of(next) == 0) {
      const WideNode& node = reader.node(next);
      for (int i = 0; i < kWidth; ++i) {
        const bool touches = node.lo_x[i] <= box.hi.x && box.lo.x <= node.hi_x[i] &&
                             node.lo_y[i] <= box.hi.y && box.lo.y <= node.hi_y[i] &&
                             node.lo_z[i] <= box.hi.z && box.lo.z <= node.hi_z[i];
        if (touches) stack[size++] = node.child[i];
      }
      continue;
    }
    const auto [begin, end] = entries_of(next);
    const bool are_triangles = build::kind_of(next) == child_ref::kTriangles;
    for (std::uint32_t k = begin; k < end; ++k) {
      if (!are_triangles) {
        f(reader.other(k));
        continue;
      }
      const TriangleBlock& block = reader.block(k);
      for (std::size_t i = 0; i < kWidth; ++i)
        if (is_used(block, i)) f(block.id[i]);
    }
  }
}

}  // namespace microtrace
