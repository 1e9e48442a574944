#pragma once
/// Visits the primitives of a tree, and of its instances, in no particular order.

#include "accel/build/tree.hpp"
#include "accel/build/wide/wide_tree.hpp"
#include "accel/layout.hpp"
#include "accel/walk/tree_reader.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace microtrace {

/// Visits the children of each node that chosen(node) returns, as one bit per child. Calls
/// on_block(block) for the blocks of triangles in leaves, and on_other(id) for other primitives. A
/// primitive may be visited several times. The tree must have leaves.
template <class Chosen, class OnBlock, class OnOther>
void walk_tree(const Tree& tree, const Chosen& chosen, const OnBlock& on_block,
               const OnOther& on_other) {
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
      for (unsigned lanes = chosen(node); lanes != 0; lanes &= lanes - 1)
        stack[size++] = node.child[std::countr_zero(lanes)];
      continue;
    }
    const auto [begin, end] = entries_of(next);
    const bool are_triangles = build::kind_of(next) == child_ref::kTriangles;
    for (std::uint32_t i = begin; i < end; ++i) {
      if (are_triangles)
        on_block(reader.block(i));
      else
        on_other(reader.other(i));
    }
  }
}

}  // namespace microtrace
