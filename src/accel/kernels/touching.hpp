#pragma once
/// The triangles near a place.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/node_test.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

/// The lanes in which [lo, hi] and the intervals of an axis have a number in common.
template <int N>
inline Lanes overlapping(const Float<N>& lo, const Float<N>& hi, const PlaceBox& box, int axis) {
  return less_equal<N>(lo, all<N>(box.hi[axis])) & less_equal<N>(all<N>(box.lo[axis]), hi);
}

template <int N>
inline Lanes touched_children(const WideNode& node, const PlaceBox& box) {
  Lanes lanes = 0;
  for (int i = 0; i < kWidth; i += N) {
    lanes |= (overlapping<N>(load<N>(node.lo_x + i), load<N>(node.hi_x + i), box, 0) &
              overlapping<N>(load<N>(node.lo_y + i), load<N>(node.hi_y + i), box, 1) &
              overlapping<N>(load<N>(node.lo_z + i), load<N>(node.hi_z + i), box, 2))
             << i;
  }
  return lanes;
}

/// By the triangles' boxes. Unused places hold NaN, which overlaps nothing.
template <int N>
inline Lanes touched_triangles(const TriangleBlock& block, const PlaceBox& box) {
  Lanes lanes = 0;
  for (int i = 0; i < kWidth; i += N) {
    Lanes touched = all_lanes<N>;
    const float* axes[3] = {block.a_x + i, block.a_y + i, block.a_z + i};
    for (int axis = 0; axis < 3; ++axis) {
      // The corners' arrays lie one after another.
      const Float<N> a = load<N>(axes[axis]), b = load<N>(axes[axis] + 3 * kWidth),
                     c = load<N>(axes[axis] + 6 * kWidth);
      touched &= overlapping<N>(lesser(lesser(b, c), a), greater(greater(b, c), a), box, axis);
    }
    lanes |= touched << i;
  }
  return lanes;
}

/// See Kernels::touching.
template <int N>
int touching(const TreeView& tree, const PlaceBox& box, std::uint32_t* places, int capacity) {
  ChildRef stack[kStackSize + kWidth];
  int size = 0, count = 0;
  stack[size++] = tree.root;
  while (size > 0) {
    const ChildRef next = stack[--size];
    if ((next & child_ref::kKind) == 0) {
      const WideNode& node = tree.nodes[next];
      const Lanes lanes = touched_children<N>(node, box);
      store_lanes(lanes, node.child, stack + size);
      size += __builtin_popcount(lanes);
      continue;
    }
    if ((next & child_ref::kKind) != child_ref::kTriangles) return -1;
    const std::uint32_t first = (next & ~child_ref::kKind) >> 3U, end = first + (next & 7U) + 1;
    for (std::uint32_t b = first; b < end; ++b) {
      Lanes lanes = touched_triangles<N>(tree.blocks[b], box);
      for (; lanes != 0; lanes &= lanes - 1) {
        if (count == capacity) return -1;
        places[count++] = b * kWidth + static_cast<std::uint32_t>(first_lane(lanes));
      }
    }
  }
  return count;
}

}  // namespace
}  // namespace microtrace
