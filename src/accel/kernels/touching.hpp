#pragma once
/// Finds the primitives near a box.

#include "accel/kernels/block_test.hpp"
#include "accel/kernels/few_triangles.hpp"
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
    for (int axis = 0; axis < 3; ++axis) {
      const Float<N> a = load<N>(block.a[axis] + i), b = load<N>(block.b[axis] + i),
                     c = load<N>(block.c[axis] + i);
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
  const float(*vertices[])[kWidth] = {block.a, block.b, block.c};
  const Float<N> plane = all<N>(query.plane_at);
  for (int i = 0; i < kWidth; i += N) {
    Lanes within = kAllLanes<N>;
    for (const auto* vertex : vertices) {
      const Float<N> x = load<N>(vertex[query.plane_axis] + i);
      within &= less_equal<N>(x, plane) & less_equal<N>(plane, x);
    }
    lanes |= within << i;
  }
  return lanes;
}

/// Boxes as their centers and half extents, which are rounded up.
template <class F>
struct CenteredBox {
  F center[3], reach[3];

  CenteredBox(const F (&lo)[3], const F (&hi)[3]) {
    for (int k = 0; k < 3; ++k) {
      center[k] = 0.5F * lo[k] + 0.5F * hi[k];
      reach[k] = greater(hi[k] - center[k], center[k] - lo[k]) * (1 + 0x1p-20F);
    }
  }
};

/// Tests N triangles against one box, or one triangle against N boxes. Returns those of `lanes`
/// whose triangle may touch the box. The others certainly don't, because, seen along some axis, the
/// box is left of one edge and right of another. Long thin triangles often don't touch the box
/// although their bounding boxes overlap it. Let A and B be the vectors from the center to an
/// edge's ends, and r the half extents. The area A_i B_j - A_j B_i changes by at most r_i |B_j -
/// A_j| + r_j |B_i - A_i| within the box. Each of its terms has three roundings; the rounding of
/// the difference does not change its sign. Half of the eight units, and half of the margin of the
/// half extents for second-order roundings, would suffice.
template <int N, class Corner, class BoxPart>
inline Lanes without_clear(Lanes lanes, const Corner (&vertices)[3][3],
                           const CenteredBox<BoxPart>& box) {
  using F = Float<N>;
  F corners[3][3];
  for (int corner = 0; corner < 3; ++corner) {
    for (int axis = 0; axis < 3; ++axis)
      corners[corner][axis] = vertices[corner][axis] - box.center[axis];
  }
  for (int axis = 0; axis < 3 && lanes != 0; ++axis) {
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
    lanes &= ~(any_positive & any_negative);
  }
  return lanes;
}

/// The vertices of N triangles of a block, starting at i.
template <int N>
struct BlockVertices {
  Float<N> at[3][3];

  BlockVertices(const TriangleBlock& block, int i) {
    for (int axis = 0; axis < 3; ++axis) {
      at[0][axis] = load<N>(block.a[axis] + i);
      at[1][axis] = load<N>(block.b[axis] + i);
      at[2][axis] = load<N>(block.c[axis] + i);
    }
  }
};

/// Adds a slot to the results unless there are too many; returns whether there are.
inline bool adds_too_many(BoxQuery& query, std::uint32_t slot) {
  if (query.count == BoxQuery::kMost) query.count = -1;
  if (query.count >= 0) query.slots[query.count++] = slot;
  return query.count < 0;
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
  for (std::uint32_t i = first; i < end && !overflows; ++i) {
    if (!are_triangles) {
      overflows = adds_too_many(query, kOtherSlot + i);
      continue;
    }
    const TriangleBlock& block = tree.blocks[i];
    Lanes lanes = touched_triangles<N>(block, query);
    if (lanes != 0) lanes &= ~omitted_triangles<N>(block, query);
    if (lanes != 0) {  // often false on axis-aligned walls
      const CenteredBox<float> box(query.lo, query.hi);
      for (int k = 0; k < kWidth; k += N) {
        const Lanes these = lanes & kAllLanes<N> << k;
        lanes &= ~these;
        lanes |= without_clear<N>(these >> k, BlockVertices<N>(block, k).at, box) << k;
      }
    }
    for (; lanes != 0 && !overflows; lanes &= lanes - 1)
      overflows = adds_too_many(query, i * kWidth + static_cast<std::uint32_t>(first_lane(lanes)));
  }
  if (overflows) search.size = 0;
}

/// Finds the triangles near up to kBoxQueries boxes, by tests of one triangle against N boxes.
template <int N>
class FewTrianglesSearch {
 public:
  FewTrianglesSearch(const TreeView& tree, BoxQuery* queries, int count)
      : tree_(tree), queries_(queries), count_(count) {
    for (int i = 0; i < kBoxQueries; ++i) {
      const BoxQuery& query = queries[i < count ? i : 0];
      for (int k = 0; k < 3; ++k) lo_[k][i] = query.lo[k], hi_[k][i] = query.hi[k];
      plane_at_[i] = query.plane_at;
      plane_axis_[i] = static_cast<std::uint32_t>(query.plane_axis);
      omitted_id_[i] = query.omitted_id;
    }
  }

  void run() {
    for (int i = 0; i < count_; ++i) queries_[i].count = 0;
    for (int first = 0; first < count_; first += N) {
      const int rest = count_ - first;
      const Lanes all_queries = rest < N ? (Lanes{1} << rest) - 1 : kAllLanes<N>;
      F lo[3], hi[3];
      for (int axis = 0; axis < 3; ++axis)
        lo[axis] = load<N>(lo_[axis] + first), hi[axis] = load<N>(hi_[axis] + first);
      const CenteredBox<F> boxes(lo, hi);
      for (int k = 0; k < tree_.few->count; ++k) {
        const FewTriangles::Entry& triangle = tree_.few->entries[k];
        // The differences have the signs of exact ones.
        F gap = greater(F(triangle.lo[0] - hi[0]), F(lo[0] - triangle.hi[0]));
        for (int axis = 1; axis < 3; ++axis)
          gap = greater(greater(F(triangle.lo[axis] - hi[axis]), F(lo[axis] - triangle.hi[axis])),
                        gap);
        const Lanes near = all_queries & less_equal<N>(gap, F{});
        if (near != 0) meet(triangle, first, near, boxes);
      }
    }
  }

 private:
  using F = Float<N>;

  /// Adds the triangle to the queries in these lanes, whose boxes overlap its own.
  void meet(const FewTriangles::Entry& triangle, int first, Lanes lanes,
            const CenteredBox<F>& boxes) {
    lanes &= ~equal_to<N>(omitted_id_ + first, triangle.id);
    if (triangle.plane_axis >= 0) {
      const F at = load<N>(plane_at_ + first), own = all<N>(triangle.plane_at);
      const auto axis = static_cast<std::uint32_t>(triangle.plane_axis);
      lanes &= ~(equal_to<N>(plane_axis_ + first, axis) & less_equal<N>(at, own) &
                 less_equal<N>(own, at));
    }
    if (lanes == 0) return;
    lanes = without_clear<N>(lanes, triangle.vertices, boxes);
    for (; lanes != 0; lanes &= lanes - 1) {
      BoxQuery& query = queries_[first + first_lane(lanes)];
      if (query.count >= 0) adds_too_many(query, triangle.slot);
    }
  }

  const TreeView& tree_;
  BoxQuery* queries_;
  int count_;
  alignas(64) float lo_[3][kBoxQueries], hi_[3][kBoxQueries], plane_at_[kBoxQueries];
  alignas(64) std::uint32_t omitted_id_[kBoxQueries], plane_axis_[kBoxQueries];
};

/// See Kernels::touching. M: number of boxes that are tested against one triangle at a time.
template <int N, int M>
void touching(const TreeView& tree, BoxQuery* queries, int count) {
  if (has_few_triangles<M>(tree)) return FewTrianglesSearch<M>(tree, queries, count).run();
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
