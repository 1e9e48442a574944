#pragma once
/// Finds the primitives near a box.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/near/box_tests.hpp"
#include "accel/kernels/near/few_triangles_search.hpp"
#include "accel/kernels/node_test.hpp"
#include "accel/kernels/simd.hpp"
#include "simd/lane_count.hpp"

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
    const float margin = extent * (1 + 0x1p-20F) + row_max(row) * reach;
    // Finite, because infinite boxes overlap even unused slots. If the result is NaN, the box has
    // this largest extent.
    inner.lo[i] = greater(middle - margin, -__FLT_MAX__);
    inner.hi[i] = lesser(middle + margin, __FLT_MAX__);
  }
}

/// The state of a query's traversal of some subtrees.
struct BoxSearch {
  /// Each subtree but the last takes one element of the stack.
  static constexpr int kMostSubtrees = 32;

  int size;
  Scope scope;
  BoxQuery query;
  ClosedBox inner;  ///< the box in the space of the instance's mesh, in the scope of an instance
  ChildRef stack[kMostSubtrees + kStackSize + kWidth];
};

/// Adds the triangles of a block that touch query i, which omits some. `bounds` are those of the
/// block. The slot of the block's first triangle is `slot`, or kIdSlot in the scope of an instance.
/// Returns true if there are too many results.
template <int N>
inline bool adds_too_many(BoxQueries& queries, int i, const BoxQuery& query,
                          const TriangleBlock& block, const BlockBounds<N>& bounds,
                          std::uint32_t slot) {
  Lanes lanes = bounds.touched(query.box);
  if (lanes != 0) lanes &= ~omitted_triangles<N>(block, query);
  if (lanes != 0) {  // often false on axis-aligned walls
    const CenteredBox<float> box(query.box.lo, query.box.hi);
    for (int k = 0; k < kWidth; k += N) {
      const Lanes these = lanes & kAllLanes<N> << k;
      lanes &= ~these;
      lanes |= without_clear<N>(these >> k, BlockCorners<N>(block, k).of, box) << k;
    }
  }
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::uint32_t>(first_lane(lanes));
    if (slot == kIdSlot ? adds_too_many(queries, i, kIdSlot, block.id[lane])
                        : adds_too_many(queries, i, slot + lane))
      return true;
  }
  return false;
}

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
    search.size += lane_count(lanes);
    return;
  }
  if (next == kInstanceEnd) {
    search.scope = Scope(tree);
    return;
  }
  if (is_instance(next)) {
    const Instance& instance = tree.instances[next - child_ref::kFirstInstance];
    const MeshTree& mesh = tree.meshes[instance.mesh];
    search.scope = Scope(mesh, instance);
    enter(instance, query.box, search.inner);
    search.stack[search.size++] = kInstanceEnd;
    search.stack[search.size++] = mesh.root;
    return;
  }
  const auto [first, end] = entries_of(next);
  const bool are_triangles = (next & child_ref::kKind) == child_ref::kTriangles;
  bool overflows = false;
  for (std::uint32_t entry = first; entry < end && !overflows; ++entry) {
    if (!are_triangles) {
      overflows = scope.instance == nullptr
                      ? adds_too_many(queries, i, kOtherSlot + entry)
                      : adds_too_many(queries, i, kIdSlot, scope.first_id() + scope.others[entry]);
      continue;
    }
    if (scope.instance == nullptr) {
      const TriangleBlock& block = scope.blocks[entry];
      overflows = adds_too_many<N>(queries, i, query, block, BlockBounds<N>(block), entry * kWidth);
    } else if (BlockBounds<N>(scope.blocks[entry]).touched(search.inner) != 0) {
      TriangleBlock placed;
      tree.scene_block(*scope.instance, scope.blocks[entry], placed);
      overflows = adds_too_many<N>(queries, i, query, placed, BlockBounds<N>(placed), kIdSlot);
    }
  }
  if (overflows) search.size = 0;
}

/// Finds the primitives near up to kBoxQueries boxes. M: number of boxes that are tested against
/// one box of the tree at a time.
template <int N, int M>
class TreeSearch {
 public:
  TreeSearch(const TreeView& tree, BoxQueries& queries) : tree_(tree), queries_(queries) {}

  void run() {
    for (int i = 0; i < queries_.size; ++i)
      open_ |= Lanes{queries_.lo[0][i] <= queries_.hi[0][i]} << i;  // skips empty boxes
    if (tree_.instances == nullptr)
      search_together();
    else
      part(tree_.root, open_);
    int going[kBoxQueries], count = 0;
    for (Lanes lanes = parted_; lanes != 0; lanes &= lanes - 1) {
      const int i = first_lane(lanes);
      going[count] = i;
      count += searches_[i].size > 0 ? 1 : 0;  // part() may have ended the search
    }
    while (count > 0) {
      int left = 0;
      for (int k = 0; k < count; ++k) {
        const int i = going[k];
        step<N>(tree_, searches_[i], queries_, i);
        going[left] = i;
        left += searches_[i].size > 0 ? 1 : 0;
      }
      count = left;
    }
  }

 private:
  /// A subtree, and the queries whose boxes overlap its box.
  struct Subtree {
    ChildRef root;
    Lanes queries;
  };
  /// Queries that share a node are tested together if there are at least so many.
  static constexpr int kTogether = 3;

  /// Searches the subtrees that several queries share.
  void search_together() {
    Subtree stack[stack_size(false)];
    stack[0] = {tree_.root, open_};
    for (int size = 1; size > 0;) {
      const ChildRef next = stack[--size].root;
      const Lanes queries = stack[size].queries & open_;
      const ChildRef kind = next & child_ref::kKind;
      if (kind != 0) {
        search_leaf(next, queries);
      } else if (lane_count(queries) < kTogether) {
        part(next, queries);
      } else {
        const WideNode& node = tree_.nodes[next];
        for (int k = 0; k < kWidth; ++k) {
          const float lo[3] = {node.lo_x[k], node.lo_y[k], node.lo_z[k]};
          const float hi[3] = {node.hi_x[k], node.hi_y[k], node.hi_z[k]};
          const Lanes near = queries & overlapping(lo, hi);
          stack[size] = {node.child[k], near};
          size += near != 0 ? 1 : 0;
        }
      }
    }
  }

  [[nodiscard]] Lanes overlapping(const float (&lo)[3], const float (&hi)[3]) const {
    Lanes lanes = 0;
    for (int i = 0; i < kBoxQueries; i += M) {
      const Float<M> los[3] = {load<M>(queries_.lo[0] + i), load<M>(queries_.lo[1] + i),
                               load<M>(queries_.lo[2] + i)};
      const Float<M> his[3] = {load<M>(queries_.hi[0] + i), load<M>(queries_.hi[1] + i),
                               load<M>(queries_.hi[2] + i)};
      lanes |= microtrace::overlapping<M>(lo, hi, los, his) << i;
    }
    return lanes;
  }

  void search_leaf(ChildRef leaf, Lanes queries) {
    const auto [first, end] = entries_of(leaf);
    for (std::uint32_t entry = first; entry < end; ++entry) {
      if ((leaf & child_ref::kKind) != child_ref::kTriangles) {
        for (Lanes rest = queries; rest != 0; rest &= rest - 1) {
          const int i = first_lane(rest);
          close_if(adds_too_many(queries_, i, kOtherSlot + entry), i);
        }
        continue;
      }
      const TriangleBlock& block = tree_.blocks[entry];
      const BlockBounds<N> bounds(block);
      for (Lanes rest = queries; rest != 0; rest &= rest - 1) {
        const int i = first_lane(rest);
        close_if(
            adds_too_many<N>(queries_, i, query_of(queries_, i), block, bounds, entry * kWidth), i);
      }
    }
  }

  /// Ends the search for a query that has too many results.
  void close_if(bool has_too_many, int i) { open_ &= ~(Lanes{has_too_many} << i); }

  /// Leaves the subtree to a search for each query.
  void part(ChildRef root, Lanes queries) {
    for (queries &= open_; queries != 0; queries &= queries - 1) {
      const int i = first_lane(queries);
      BoxSearch& search = searches_[i];
      if ((parted_ >> i & 1U) == 0) {
        parted_ |= Lanes{1} << i;
        search.size = 0;
        search.scope = Scope(tree_);
        search.query = query_of(queries_, i);
      }
      if (search.size == BoxSearch::kMostSubtrees) {
        while (search.size > 0) step<N>(tree_, search, queries_, i);
        close_if(queries_.count[i] < 0, i);
        if ((open_ >> i & 1U) == 0) continue;
      }
      search.stack[search.size++] = root;
    }
  }

  const TreeView& tree_;
  BoxQueries& queries_;
  Lanes open_ = 0;    // queries without too many results
  Lanes parted_ = 0;  // queries with a search of their own
  BoxSearch searches_[kBoxQueries];
};

/// See Kernels::touching. M: number of boxes that are tested against one triangle or box at a time.
template <int N, int M>
void touching(const TreeView& tree, BoxQueries& queries) {
  for (int& count : queries.count) count = 0;
  if (has_few_triangles<M>(tree)) {
    FewTrianglesSearch<M>(tree, queries).run();
    if (tree.few_are_all) return;
  }
  TreeSearch<N, M>(tree, queries).run();
}

}  // namespace
}  // namespace microtrace
