#pragma once
#include "accel/build/tree.hpp"
#include "base/memory_account.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/primitives.hpp>

#include <cstddef>
#include <memory>

namespace microtrace {

/// The part of a Bvh that can be shared or reused without the scene: the tree and its memory
/// account.
struct BvhTree {
  Tree tree;
  MemoryAccount memory;
};

/// Builds the tree.
/// Throws Error (limit) if memory runs out or there are too many primitives.
[[nodiscard]] std::shared_ptr<const BvhTree> make_bvh_tree(const Primitives& primitives,
                                                           BvhOptions options);

/// Returns the size of a tree in bytes.
[[nodiscard]] std::size_t memory_of(const Tree& tree);

}  // namespace microtrace
