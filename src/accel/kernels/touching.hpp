#pragma once
/// Finds the primitives near a box.

#include "accel/kernels/box_tests.hpp"
#include "accel/kernels/few_triangles.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/node_test.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

/// Sets `inner` to a box in the space of an instance's mesh that contains every point whose image,
/// rounded, may touch the query's box. The margins are those of InnerRay for an origin in the box.
inline void enter(const Instance& instance, const ClosedBox& query, ClosedBox& inner) {
  float c[3], half[3], distance = 0;
  for (int j = 0; j < 3; ++j) {
    const double t = instance.scene_from_mesh[9 + j];
    const double lo = double{query.lo[j]} - t, hi = double{query.hi[j]} - t;
    c[j] = static_cast<float>(0.5 * (lo + hi));
    half[j] = static_cast<float>(0.5 * (hi - lo)) * (1 + 0x1p-20F);
    distance += __builtin_fabsf(c[j]) + half[j];
  }
  const float reach = distance * (13 * 0x1p-24F) + instance.reach;
  for (int i = 0; i < 3; ++i) {
    const float(&row)[3] = instance.mesh_from_scene[i];
    const float middle = row[0] * c[0] + row[1] * c[1] + row[2] * c[2];
    const float extent = __builtin_fabsf(row[0]) * half[0] + __builtin_fabsf(row[1]) * half[1] +
                         __builtin_fabsf(row[2]) * half[2];
    const float margin = extent * (1 + 0x1p-20F) + instance.row_max[i] * reach;
    // Finite, because infinite boxes overlap even unused slots. If the result is NaN, the box has
    // this largest extent.
    inner.lo[i] = greater(middle - margin, -__FLT_MAX__);
    inner.hi[i] = lesser(middle + margin, __FLT_MAX__);
  }
}

/// The state of a query's traversal.
struct BoxSearch {
  int size;
  Scope scope;
  BoxQuery query;
  ClosedBox inner;  ///< the box in the space of the instance's mesh, in the scope of an instance
  ChildRef stack[kStackSize + kWidth];
};

/// Visits the next node or leaf of query i.
template <int N>
inline void step(const TreeView& tree, BoxSearch& search, BoxQueries& queries, int i) {
  const BoxQuery& query = search.query;
  const ChildRef next = search.stack[--search.size];
  const Scope& scope = search.scope;
  if ((next & child_ref::kKind) == 0) {
    const WideNode& node = scope.nodes[next];
    const Lanes lanes = touched_children<N>(node, scope.choose(query.box, search.inner));
    store_lanes(lanes, node.child, search.stack + search.size);
    search.size += __builtin_popcount(lanes);
    return;
  }
  if (next == kInstanceEnd) {
    search.scope = Scope(tree);
    return;
  }
  if (is_instance(next)) {
    const Instance& instance = tree.instances[next - child_ref::kFirstInstance];
    search.scope = Scope(instance);
    enter(instance, query.box, search.inner);
    search.stack[search.size++] = kInstanceEnd;
    search.stack[search.size++] = instance.mesh->root;
    return;
  }
  const std::uint32_t first = (next & ~child_ref::kKind) >> 3U, end = first + (next & 7U) + 1;
  const bool are_triangles = (next & child_ref::kKind) == child_ref::kTriangles;
  bool overflows = false;
  for (std::uint32_t entry = first; entry < end && !overflows; ++entry) {
    if (!are_triangles) {
      overflows = scope.instance == nullptr
                      ? adds_too_many(queries, i, kOtherSlot + entry)
                      : adds_too_many(queries, i, kIdSlot, scope.first_id() + scope.others[entry]);
      continue;
    }
    TriangleBlock placed;
    if (scope.instance != nullptr) {
      if (touched_triangles<N>(scope.blocks[entry], search.inner) == 0) continue;
      tree.scene_block(*scope.instance, scope.blocks[entry], placed);
    }
    const TriangleBlock& block = scope.choose(scope.blocks[entry], placed);
    Lanes lanes = touched_triangles<N>(block, query.box);
    if (lanes != 0) lanes &= ~omitted_triangles<N>(block, query);
    if (lanes != 0) {  // often false on axis-aligned walls
      const CenteredBox<float> box(query.box.lo, query.box.hi);
      for (int k = 0; k < kWidth; k += N) {
        const Lanes these = lanes & kAllLanes<N> << k;
        lanes &= ~these;
        lanes |= without_clear<N>(these >> k, BlockVertices<N>(block, k).at, box) << k;
      }
    }
    for (; lanes != 0 && !overflows; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(first_lane(lanes));
      overflows = scope.instance == nullptr ? adds_too_many(queries, i, entry * kWidth + lane)
                                            : adds_too_many(queries, i, kIdSlot, block.id[lane]);
    }
  }
  if (overflows) search.size = 0;
}

/// Finds the triangles near up to kBoxQueries boxes, by tests of one triangle against N boxes.
template <int N>
class FewTrianglesSearch {
 public:
  FewTrianglesSearch(const TreeView& tree, BoxQueries& queries) : tree_(tree), queries_(queries) {}

  void run() {
    for (int first = 0; first < queries_.size; first += N) {
      const int rest = queries_.size - first;
      const Lanes all_queries = rest < N ? (Lanes{1} << rest) - 1 : kAllLanes<N>;
      F lo[3], hi[3];
      for (int axis = 0; axis < 3; ++axis)
        lo[axis] = load<N>(queries_.lo[axis] + first),
        hi[axis] = load<N>(queries_.hi[axis] + first);
      const CenteredBox<F> boxes(lo, hi);
      for (int k = 0; k < tree_.few->ends[FewTriangles::kOblique]; ++k) {
        const FewTriangles::Facet& facet = tree_.few->facets[k];
        const Lanes near = all_queries & overlapping(facet.box, lo, hi);
        if (near == 0) continue;
        for (const int number : {facet.first, facet.second}) {
          if (number < 0) break;
          const FewTriangles::Entry& triangle = tree_.few->entries[number];
          Lanes lanes = without_omitted(triangle, first, near);
          if (lanes != 0 && facet.second >= 0) lanes &= overlapping(triangle.box, lo, hi);
          if (lanes != 0) lanes = without_clear<N>(lanes, triangle.vertices, boxes);
          for (; lanes != 0; lanes &= lanes - 1) {
            const int i = first + first_lane(lanes);
            if (queries_.count[i] >= 0) adds_too_many(queries_, i, triangle.slot);
          }
        }
      }
    }
  }

 private:
  using F = Float<N>;

  [[nodiscard]] static Lanes overlapping(const FewTriangles::Box& box, const F (&lo)[3],
                                         const F (&hi)[3]) {
    // The differences have the signs of exact ones.
    F gap = greater(F(box.lo[0] - hi[0]), F(lo[0] - box.hi[0]));
    for (int axis = 1; axis < 3; ++axis)
      gap = greater(greater(F(box.lo[axis] - hi[axis]), F(lo[axis] - box.hi[axis])), gap);
    return less_equal<N>(gap, F{});
  }

  /// Returns those of `lanes` whose queries don't omit the triangle.
  [[nodiscard]] Lanes without_omitted(const FewTriangles::Entry& triangle, int first,
                                      Lanes lanes) const {
    lanes &= ~equal_to<N>(queries_.omitted_id + first, triangle.id);
    if (triangle.plane_axis < 0) return lanes;
    const F at = load<N>(queries_.plane_at + first), own = all<N>(triangle.plane_at);
    const F axes = load<N>(queries_.plane_axis + first);
    const F axis = all<N>(static_cast<float>(triangle.plane_axis));
    return lanes & ~(less_equal<N>(axes, axis) & less_equal<N>(axis, axes) &
                     less_equal<N>(at, own) & less_equal<N>(own, at));
  }

  const TreeView& tree_;
  BoxQueries& queries_;
};

/// See Kernels::touching. M: number of boxes that are tested against one triangle at a time.
template <int N, int M>
void touching(const TreeView& tree, BoxQueries& queries) {
  for (int& count : queries.count) count = 0;
  if (has_few_triangles<M>(tree)) return FewTrianglesSearch<M>(tree, queries).run();
  BoxSearch searches[kBoxQueries];
  int going[kBoxQueries], left = 0;
  for (int i = 0; i < queries.size; ++i) {
    searches[i].size = 1;
    searches[i].scope = Scope(tree);
    searches[i].query = query_of(queries, i);
    searches[i].stack[0] = tree.root;
    going[left] = i;
    left += queries.lo[0][i] <= queries.hi[0][i] ? 1 : 0;  // skips empty boxes
  }
  int count = left;
  while (count > 0) {
    left = 0;
    for (int k = 0; k < count; ++k) {
      const int i = going[k];
      step<N>(tree, searches[i], queries, i);
      going[left] = i;
      left += searches[i].size > 0 ? 1 : 0;
    }
    count = left;
  }
}

}  // namespace
}  // namespace microtrace
