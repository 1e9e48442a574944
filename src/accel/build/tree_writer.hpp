#pragma once
#include "accel/build/binary_tree.hpp"
#include "accel/build/tree.hpp"
#include "accel/build/worker_pool.hpp"

namespace microtrace::build {

/// A node without children.
[[nodiscard]] WideNode empty_node();

/// Writes the planned tree's nodes, blocks and list of others; leaves `unbounded` alone.
///
/// Order in memory: the inner children of a node lie side by side, then follows all that is below
/// the first, then all below the second, and so on; leaves in the same order. So a node's children
/// are on one page, mostly its own, and a small subtree fills a short range. Throws Error (limit)
/// if references would overflow.
void write_tree(const BinaryTree& planned, const Primitives& primitives, WorkerPool& pool,
                Tree& tree);

}  // namespace microtrace::build
