#pragma once
#include "accel/build/binary/binary_tree.hpp"
#include "accel/build/tree.hpp"
#include "accel/build/worker_pool.hpp"

namespace microtrace::build {

/// Writes the planned tree's nodes, blocks and list of other primitives; leaves `unbounded` alone.
///
/// Memory order: the inner children of a node are consecutive, followed by the subtree of the
/// first, the subtree of the second, and so on; leaves are in the same order. A node's children are
/// therefore on one page, mostly that of the node, and a small subtree is a short range. Throws
/// Error (limit) if references would overflow.
void write_tree(const BinaryTree& planned, const Primitives& primitives, WorkerPool& pool,
                Tree& tree);

}  // namespace microtrace::build
