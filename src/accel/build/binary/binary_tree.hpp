#pragma once
/// The binary tree that is later collapsed to nodes with up to eight children.

#include "accel/build/references/references.hpp"
#include "accel/build/worker_pool.hpp"

#include <array>
#include <bit>
#include <memory>

namespace microtrace::build {

/// The optimal collapse of a node and its subtree; see collapse.hpp.
class CollapsePlan {
 public:
  /// True if the whole subtree becomes one leaf.
  [[nodiscard]] bool is_leaf() const { return (bits_ & kLeaf) != 0; }
  /// How many of `parts` subtrees, 2 to 8, come from the left child; 0: the same collapse as for
  /// `parts` - 1.
  [[nodiscard]] unsigned to_left(unsigned parts) const { return bits_ >> shift(parts) & 7U; }

  void set_leaf(bool is_leaf) { bits_ = is_leaf ? bits_ | kLeaf : bits_ & ~kLeaf; }
  void set_to_left(unsigned parts, unsigned to_left) {
    bits_ = (bits_ & ~(7U << shift(parts))) | to_left << shift(parts);
  }

 private:
  static constexpr std::uint32_t kLeaf = 1;
  static constexpr unsigned shift(unsigned parts) { return 3 * parts - 5; }

  std::uint32_t bits_ = kLeaf;
};

/// A node's expected cost if it is collapsed to at most i + 1 subtrees.
using CollapseCosts = std::array<float, 8>;

/// A node with references whose ids start at BinaryTree::ids[begin]. The fourth lanes of the box
/// hold their number and the sum of their weights.
struct BinaryNode {
  Box box;
  BinaryNode* children = nullptr;  ///< two consecutive nodes; null for a leaf
  std::uint32_t begin = 0;
  CollapsePlan plan;

  void set(const Box& bounds, std::uint32_t count, std::uint32_t weight) {
    box = bounds;
    box.lo[3] = std::bit_cast<float>(count);
    box.hi[3] = std::bit_cast<float>(weight);
  }
  [[nodiscard]] std::uint32_t count() const { return std::bit_cast<std::uint32_t>(box.lo[3]); }
  [[nodiscard]] std::uint32_t weight() const { return std::bit_cast<std::uint32_t>(box.hi[3]); }
};
// Large scenes have one for each four triangles, and two for each instance.
static_assert(sizeof(BinaryNode) == 48);

[[nodiscard]] inline bool is_instance(const BinaryNode& node) {
  return node.count() == 1 && node.weight() == kInstanceWeight;
}

/// True if all primitives of a node are triangles, which have this weight.
[[nodiscard]] inline bool has_triangles(const BinaryNode& node, std::uint32_t triangle_weight) {
  return node.weight() == node.count() * triangle_weight;
}

/// Allocates nodes with stable addresses. Their memory returns to the system with the arena.
class NodeArena {
 public:
  /// Allocates two consecutive nodes and returns the first.
  [[nodiscard]] BinaryNode* allocate_pair();

 private:
  static constexpr std::size_t kChunk = 4096;

  struct Unmap {
    void operator()(BinaryNode* chunk) const;
  };

  std::vector<std::unique_ptr<BinaryNode[], Unmap>> chunks_;
  std::size_t used_ = kChunk;
};

/// Nodes built by one thread, with ids from BinaryTree::ids[begin] on.
struct BinarySubtree {
  std::uint32_t begin = 0;
  NodeArena nodes{};
};

struct BinaryTree {
  BinaryNode root;
  NodeArena top;                        ///< nodes built by all threads together
  std::vector<BinarySubtree> subtrees;  ///< in ascending order of `begin`
  PageVector<PrimitiveId> ids;
  std::uint32_t triangle_weight = kTriangleWeight;  ///< see References
};

/// Splits the references until each leaf holds one kind of primitive and at most eight triangles or
/// one other primitive, and plans the collapse of all nodes. The references are sorted. The
/// result depends only on the references and their order. `bins` is at most kMaxBins.
[[nodiscard]] BinaryTree build_binary_tree(References references, int bins, WorkerPool& pool);

}  // namespace microtrace::build
