#pragma once
/// Finds the primitives of a tree near a box.

#include "accel/build/tree.hpp"
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
    const std::uint32_t first = (next & ~child_ref::kKind) >> 3U, count = (next & 7U) + 1;
    if ((next & child_ref::kKind) == 0) {
      const WideNode& node = reader.node(next);
      for (int i = 0; i < kWidth; ++i) {
        const bool touches = node.lo_x[i] <= box.hi.x && box.lo.x <= node.hi_x[i] &&
                             node.lo_y[i] <= box.hi.y && box.lo.y <= node.hi_y[i] &&
                             node.lo_z[i] <= box.hi.z && box.lo.z <= node.hi_z[i];
        if (touches) stack[size++] = node.child[i];
      }
    } else if ((next & child_ref::kKind) == child_ref::kTriangles) {
      for (std::uint32_t b = first; b < first + count; ++b) {
        const TriangleBlock& block = reader.block(b);
        for (int i = 0; i < kWidth; ++i) {
          const bool used = block.a[0][i] == block.a[0][i];  // unused slots have NaN
          if (used) f(block.id[i]);
        }
      }
    } else {
      for (std::uint32_t k = first; k < first + count; ++k) f(reader.other(k));
    }
  }
}

}  // namespace microtrace
