#pragma once
#include "accel/build/tree.hpp"
#include "base/memory_account.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/primitives.hpp>

#include <cstddef>
#include <memory>

namespace microtrace {

/// The part of a Bvh that scenes can share: the tree and its memory account.
struct BvhTree {
  Tree tree;
  MemoryAccount memory;
};

/// Keeps the primitives of small scenes in Tree::unbounded, without a tree. Throws Error (limit).
[[nodiscard]] std::shared_ptr<const BvhTree> make_bvh_tree(const Primitives& primitives,
                                                           BvhOptions options);

/// In bytes.
[[nodiscard]] std::size_t memory_of(const Tree& tree);

}  // namespace microtrace
