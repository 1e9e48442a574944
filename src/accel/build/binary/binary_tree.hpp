#pragma once
/// The binary tree that is later collapsed to nodes with up to eight children.

#include "accel/build/references/references.hpp"
#include "accel/build/worker_pool.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
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

/// A node with references whose ids start at BinaryTree::ids[begin()]. Large scenes have one for
/// each four triangles, and two for each instance, so it has no room for what its children tell.
class BinaryNode {
 public:
  /// Sets the bounds, the number of references and the sum of their weights.
  void set(const Box& bounds, std::uint32_t count, std::uint32_t weight) {
    std::memcpy(lo_, &bounds.lo, sizeof lo_);
    std::memcpy(hi_, &bounds.hi, sizeof hi_);
    count_ = count;
    weight_or_plan_ = weight;
  }
  /// Makes the node a leaf whose ids start here.
  void set_begin(std::uint32_t begin) { link_ = std::uintptr_t{begin} << kTagBits | kLeaf; }
  /// Makes two consecutive nodes the children. The second begins where the first ends.
  void set_children(BinaryNode* children) { link_ = reinterpret_cast<std::uintptr_t>(children); }
  /// Stores the plan of a node with children, in the place of its weight.
  void set_plan(CollapsePlan plan) {
    link_ |= kPlanned;
    weight_or_plan_ = std::bit_cast<std::uint32_t>(plan);
  }

  [[nodiscard]] Box box() const {
    return Box{.lo = {lo_[0], lo_[1], lo_[2], 0}, .hi = {hi_[0], hi_[1], hi_[2], 0}};
  }
  [[nodiscard]] std::uint32_t count() const { return count_; }
  [[nodiscard]] std::uint32_t weight() const {
    return is_planned() ? children()[0].weight() + children()[1].weight() : weight_or_plan_;
  }
  /// Returns two consecutive nodes, or null for a leaf.
  [[nodiscard]] BinaryNode* children() const {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): set_children() converted it
    return (link_ & kLeaf) == 0 ? reinterpret_cast<BinaryNode*>(link_ & ~kPlanned) : nullptr;
  }
  [[nodiscard]] std::uint32_t begin() const {
    const BinaryNode* first = this;
    while (const BinaryNode* const children = first->children()) first = children;
    return static_cast<std::uint32_t>(first->link_ >> kTagBits);
  }
  [[nodiscard]] CollapsePlan plan() const {
    return is_planned() ? std::bit_cast<CollapsePlan>(weight_or_plan_) : CollapsePlan();
  }

 private:
  // Bits of link_. The addresses of nodes are multiples of 8.
  static constexpr std::uintptr_t kLeaf = 1, kPlanned = 2;
  static constexpr unsigned kTagBits = 2;

  [[nodiscard]] bool is_planned() const { return (link_ & kPlanned) != 0; }

  float lo_[3];
  std::uint32_t count_;
  float hi_[3];
  std::uint32_t weight_or_plan_;
  std::uintptr_t link_ = kLeaf;  // the children, or the begin of a leaf
};
static_assert(sizeof(BinaryNode) == 40);

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
