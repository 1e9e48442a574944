#pragma once
/// Finds the primitives near a box.

#include "accel/kernels/block_test.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/node_test.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

/// Returns the lanes in which [lo, hi] overlaps the box along an axis.
template <int N>
inline Lanes overlapping(const Float<N>& lo, const Float<N>& hi, const BoxQuery& box, int axis) {
  return less_equal<N>(lo, all<N>(box.hi[axis])) & less_equal<N>(all<N>(box.lo[axis]), hi);
}

template <int N>
inline Lanes touched_children(const WideNode& node, const BoxQuery& box) {
  Lanes lanes = 0;
  for (int i = 0; i < kWidth; i += N) {
    lanes |= (overlapping<N>(load<N>(node.lo_x + i), load<N>(node.hi_x + i), box, 0) &
              overlapping<N>(load<N>(node.lo_y + i), load<N>(node.hi_y + i), box, 1) &
              overlapping<N>(load<N>(node.lo_z + i), load<N>(node.hi_z + i), box, 2))
             << i;
  }
  return lanes;
}

/// Returns the triangles whose bounding boxes overlap the box. Unused slots are NaN and overlap
/// nothing.
template <int N>
inline Lanes touched_triangles(const TriangleBlock& block, const BoxQuery& box) {
  Lanes lanes = 0;
  for (int i = 0; i < kWidth; i += N) {
    Lanes touched = kAllLanes<N>;
    const float* axes[3] = {block.a_x + i, block.a_y + i, block.a_z + i};
    for (int axis = 0; axis < 3; ++axis) {
      // The arrays of a, b and c are consecutive in memory.
      const Float<N> a = load<N>(axes[axis]), b = load<N>(axes[axis] + 3 * kWidth),
                     c = load<N>(axes[axis] + 6 * kWidth);
      touched &= overlapping<N>(lesser(lesser(b, c), a), greater(greater(b, c), a), box, axis);
    }
    lanes |= touched << i;
  }
  return lanes;
}

/// Returns the triangles that the query omits.
template <int N>
inline Lanes omitted_triangles(const TriangleBlock& block, const BoxQuery& query) {
  Lanes lanes = lanes_within(block.id, query.omitted_id, query.omitted_id);
  if (query.plane_axis < 0) return lanes;
  const float* coordinates = block.a_x + query.plane_axis * kWidth;
  const Float<N> plane = all<N>(query.plane_at);
  for (int i = 0; i < kWidth; i += N) {
    Lanes within = kAllLanes<N>;
    for (int corner = 0; corner < 3; ++corner) {
      const Float<N> x = load<N>(coordinates + 3 * kWidth * corner + i);
      within &= less_equal<N>(x, plane) & less_equal<N>(plane, x);
    }
    lanes |= within << i;
  }
  return lanes;
}

/// A box as its center and half extents, which are rounded up.
struct CenteredBox {
  float center[3], reach[3];

  explicit CenteredBox(const BoxQuery& box) {
    for (int k = 0; k < 3; ++k) {
      center[k] = 0.5F * box.lo[k] + 0.5F * box.hi[k];
      reach[k] = greater(box.hi[k] - center[k], center[k] - box.lo[k]) * (1 + 0x1p-20F);
    }
  }
};

/// Returns triangles that certainly don't touch the box because, seen along some axis, the box is
/// left of one edge and right of another. Long thin triangles often don't touch the box although
/// their bounding boxes overlap it. Let A and B be the vectors from the center to an edge's ends,
/// and r the half extents. The area A_i B_j - A_j B_i changes by at most r_i |B_j - A_j| + r_j |B_i
/// - A_i| within the box. Each of its terms has three roundings; the rounding of the difference
/// does not change its sign. Half of the eight units, and half of the margin of the half extents
/// for second-order roundings, would suffice.
template <int N>
inline Lanes clear_triangles(const TriangleBlock& block, int i, const CenteredBox& box) {
  using F = Float<N>;
  F corners[3][3];
  const float* axes[3] = {block.a_x + i, block.a_y + i, block.a_z + i};
  for (int corner = 0; corner < 3; ++corner) {
    for (int axis = 0; axis < 3; ++axis)
      corners[corner][axis] = load<N>(axes[axis] + 3 * kWidth * corner) - box.center[axis];
  }
  Lanes passing = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    Lanes any_positive = 0, any_negative = 0;
    for (int corner = 0; corner < 3; ++corner) {
      const F(&a)[3] = corners[corner];
      const F(&b)[3] = corners[(corner + 1) % 3];
      const F left = a[j] * b[k], right = a[k] * b[j], area = left - right;
      const F error = (magnitude(left) + magnitude(right)) * (8 * kUnit) +
                      (magnitude(a[k]) + magnitude(b[k])) * (box.reach[j] * (1 + 0x1p-20F)) +
                      (magnitude(a[j]) + magnitude(b[j])) * (box.reach[k] * (1 + 0x1p-20F)) + kTiny;
      any_positive |= less<N>(error, area);
      any_negative |= less<N>(area, -error);
    }
    passing |= any_positive & any_negative;
  }
  return passing;
}

/// The state of a query's traversal.
struct BoxSearch {
  int size;
  ChildRef stack[kStackSize + kWidth];
};

/// Visits the next node or leaf of a query.
template <int N>
inline void step(const TreeView& tree, BoxSearch& search, BoxQuery& query) {
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
  const auto add = [&](std::uint32_t slot) {
    overflows = query.count == BoxQuery::kMost;
    if (!overflows) query.slots[query.count++] = slot;
  };
  for (std::uint32_t i = first; i < end && !overflows; ++i) {
    if (!are_triangles) {
      add(kOtherSlot + i);
      continue;
    }
    Lanes lanes = touched_triangles<N>(tree.blocks[i], query);
    if (lanes != 0) lanes &= ~omitted_triangles<N>(tree.blocks[i], query);
    if (lanes != 0) {  // often false on axis-aligned walls
      const CenteredBox box(query);
      for (int k = 0; k < kWidth; k += N)
        lanes &= ~(clear_triangles<N>(tree.blocks[i], k, box) << k);
    }
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
void touching(const TreeView& tree, BoxQuery* queries, int count) {
  BoxSearch searches[kBoxQueries];
  int going[kBoxQueries];
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
