#pragma once
/// Finds the primitives of a tree near a box.

#include "accel/build/tree.hpp"
#include "accel/layout.hpp"
#include "accel/walk/tree_walk.hpp"

#include <algorithm>
#include <cstddef>

namespace microtrace {

/// Returns true if two closed boxes have a point in common.
[[nodiscard]] inline bool overlap(const Bounds& a, const Bounds& b) {
  for (int k = 0; k < 3; ++k) {
    if (a.hi[k] < b.lo[k] || b.hi[k] < a.lo[k]) return false;
  }
  return true;
}

/// Returns true if the bounding box of the triangle in a slot overlaps a box.
[[nodiscard]] inline bool overlaps(const TriangleBlock& block, std::size_t slot,
                                   const Bounds& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const float a = coordinate(block, 0, slot, axis), b = coordinate(block, 1, slot, axis),
                c = coordinate(block, 2, slot, axis);
    if (box.hi[axis] < std::min({a, b, c}) || std::max({a, b, c}) < box.lo[axis]) return false;
  }
  return true;
}

/// Calls f(id) for every primitive in the tree with a point in the closed box. May also call f for
/// other primitives nearby, and more than once for a primitive.
template <class F>
void for_each_touching(const Tree& tree, const Bounds& box, const F& f) {
  const auto touched = [&](const WideNode& node) {
    unsigned lanes = 0;
    for (int i = 0; i < kWidth; ++i) {
      const bool touches = node.lo_x[i] <= box.hi.x && box.lo.x <= node.hi_x[i] &&
                           node.lo_y[i] <= box.hi.y && box.lo.y <= node.hi_y[i] &&
                           node.lo_z[i] <= box.hi.z && box.lo.z <= node.hi_z[i];
      lanes |= unsigned{touches} << i;
    }
    return lanes;
  };
  const auto visit = [&](const TriangleBlock& block) {
    for (std::size_t i = 0; i < kWidth; ++i)
      if (is_used(block, i) && overlaps(block, i, box)) f(block.id[i]);
  };
  walk_tree(tree, touched, visit, f);
}

}  // namespace microtrace
