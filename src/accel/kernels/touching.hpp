#pragma once
/// The triangles near a place.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/node_test.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

/// The lanes in which [lo, hi] and the intervals of an axis have a number in common.
template <int N>
inline Lanes overlapping(const Float<N>& lo, const Float<N>& hi, const PlaceQuery& box, int axis) {
  return less_equal<N>(lo, all<N>(box.hi[axis])) & less_equal<N>(all<N>(box.lo[axis]), hi);
}

template <int N>
inline Lanes touched_children(const WideNode& node, const PlaceQuery& box) {
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
inline Lanes touched_triangles(const TriangleBlock& block, const PlaceQuery& box) {
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

/// A query on its way through the tree.
struct PlaceSearch {
  int size;
  ChildRef stack[kStackSize + kWidth];
};

/// One node or leaf further.
template <int N>
inline void step(const TreeView& tree, PlaceSearch& search, PlaceQuery& query) {
  const ChildRef next = search.stack[--search.size];
  if ((next & child_ref::kKind) == 0) {
    const WideNode& node = tree.nodes[next];
    const Lanes lanes = touched_children<N>(node, query);
    store_lanes(lanes, node.child, search.stack + search.size);
    search.size += __builtin_popcount(lanes);
    return;
  }
  const std::uint32_t first = (next & ~child_ref::kKind) >> 3U, end = first + (next & 7U) + 1;
  const bool are_triangles = (next & child_ref::kKind) == child_ref::kTriangles;
  bool overflows = false;
  const auto add = [&](std::uint32_t place) {
    overflows = query.count == PlaceQuery::kMost;
    if (!overflows) query.places[query.count++] = place;
  };
  for (std::uint32_t i = first; i < end && !overflows; ++i) {
    if (!are_triangles) {
      add(kOtherPlace + i);
      continue;
    }
    Lanes lanes = touched_triangles<N>(tree.blocks[i], query);
    for (; lanes != 0 && !overflows; lanes &= lanes - 1)
      add(i * kWidth + static_cast<std::uint32_t>(first_lane(lanes)));
  }
  if (overflows) {
    query.count = -1;
    search.size = 0;
  }
}

/// See Kernels::touching.
template <int N>
void touching(const TreeView& tree, PlaceQuery* queries, int count) {
  PlaceSearch searches[kPlaceQueries];
  int going[kPlaceQueries];
  for (int i = 0; i < count; ++i) {
    searches[i].size = 1;
    searches[i].stack[0] = tree.root;
    queries[i].count = 0;
    going[i] = i;
  }
  while (count > 0) {
    int left = 0;
    for (int k = 0; k < count; ++k) {
      const int i = going[k];
      step<N>(tree, searches[i], queries[i]);
      going[left] = i;
      left += searches[i].size > 0 ? 1 : 0;
    }
    count = left;
  }
}

}  // namespace
}  // namespace microtrace
