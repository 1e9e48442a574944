#pragma once
/// Visits all leaves of a tree that a ray may meet, in no particular order, for queries that need
/// all hits.

#include "accel/layout.hpp"
#include "accel/walk/tree_walk.hpp"
#include "queries/tree_target.hpp"

#include <microtrace/ray.hpp>

namespace microtrace {

/// Calls on_block(block, lanes) for blocks of triangles in boxes that the ray meets, where `lanes`
/// are the triangles that the ray may hit. Calls on_other(id) for other primitives in such boxes,
/// and for primitives outside of the tree's boxes. Primitives may be visited several times.
template <class OnBlock, class OnOther>
void for_each_candidate(const TreeTarget& target, const Ray& ray, const OnBlock& on_block,
                        const OnOther& on_other) {
  const Tree& tree = target.tree;
  const auto& kernels = target.kernels;
  for (const PrimitiveId id : tree.unbounded) on_other(id);
  if (!tree.has_leaves()) return;
  const LineInterval line{.o = {ray.o.x, ray.o.y, ray.o.z},
                          .d = {ray.d.x, ray.d.y, ray.d.z},
                          .t_min = ray.t_min,
                          .t_max = ray.t_max};
  walk_tree(
      tree, [&](const WideNode& node) { return kernels.entered(node, line); },
      [&](const TriangleBlock& block) {
        if (const unsigned lanes = kernels.passed(block, line); lanes != 0) on_block(block, lanes);
      },
      on_other);
}

}  // namespace microtrace
