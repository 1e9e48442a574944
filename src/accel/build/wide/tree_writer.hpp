#pragma once
#include "accel/build/binary/binary_tree.hpp"
#include "accel/build/instances/instances.hpp"
#include "accel/build/tree.hpp"
#include "accel/build/worker_pool.hpp"

namespace microtrace::build {

/// Writes the nodes, blocks, list of other primitives and instances of the planned tree; does not
/// change `unbounded`. Releases nodes and ids of `planned` that are no longer needed. Throws Error
/// (limit) if the tree is too large for its references.
///
/// In memory, the inner children of a node are consecutive, followed by the subtree of the first,
/// the subtree of the second, and so on. Nodes with very many primitives and their children come
/// first, and so do the leaves right below them. A node's children are therefore on one page,
/// usually the page of the node itself, and a small subtree is a short range.
void write_tree(BinaryTree& planned, const Primitives& primitives, const Instances& instances,
                WorkerPool& pool, Tree& tree);

}  // namespace microtrace::build
