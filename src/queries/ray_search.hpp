#pragma once
/// Visits all leaves of a tree that a ray may meet, in no particular order, for queries that need
/// all hits.

#include "accel/build/wide/wide_tree.hpp"
#include "accel/instances/tree_reader.hpp"
#include "accel/layout.hpp"
#include "queries/tree_target.hpp"

#include <microtrace/ray.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace microtrace {

/// Calls on_block(block, lanes) for blocks of triangles in boxes that the ray meets, where `lanes`
/// are the triangles that the ray may hit. Calls on_other(id) for other primitives in such boxes,
/// and for primitives outside of the tree's boxes. Primitives may be visited several times.
template <class OnBlock, class OnOther>
void for_each_candidate(const TreeTarget& target, const Ray& ray, const OnBlock& on_block,
                        const OnOther& on_other) {
  const auto& [primitives, tree, kernels] = target;
  for (const PrimitiveId id : tree.unbounded) on_other(id);
  if (!tree.has_leaves()) return;
  const LineInterval line{.o = {ray.o.x, ray.o.y, ray.o.z},
                          .d = {ray.d.x, ray.d.y, ray.d.z},
                          .t_min = ray.t_min,
                          .t_max = ray.t_max};
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
      for (unsigned lanes = kernels.entered(node, line); lanes != 0; lanes &= lanes - 1)
        stack[size++] = node.child[std::countr_zero(lanes)];
      continue;
    }
    const auto [begin, end] = entries_of(next);
    const bool are_triangles = build::kind_of(next) == child_ref::kTriangles;
    for (std::uint32_t i = begin; i < end; ++i) {
      if (!are_triangles) {
        on_other(reader.other(i));
        continue;
      }
      const TriangleBlock& block = reader.block(i);
      if (const unsigned lanes = kernels.passed(block, line); lanes != 0) on_block(block, lanes);
    }
  }
}

}  // namespace microtrace
