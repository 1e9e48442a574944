#pragma once
#include "accel/build/tree.hpp"
#include "base/memory_account.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/primitives.hpp>

#include <cstddef>
#include <memory>

namespace microtrace {

/// What scenes share of a Bvh: the tree, and the memory that it takes.
struct BvhTree {
  Tree tree;
  MemoryAccount memory;
};

/// All of few primitives are in Tree::unbounded. Throws Error (limit).
[[nodiscard]] std::shared_ptr<const BvhTree> make_bvh_tree(const Primitives& primitives,
                                                           BvhOptions options);

/// In bytes.
[[nodiscard]] std::size_t memory_of(const Tree& tree);

}  // namespace microtrace
