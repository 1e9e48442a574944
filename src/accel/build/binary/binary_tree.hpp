#pragma once
/// The binary tree that is later collapsed to nodes with up to eight children.

#include "accel/build/references/reference.hpp"
#include "accel/build/worker_pool.hpp"

#include <array>
#include <memory>

namespace microtrace::build {

/// The optimal collapse of a node and its subtree; see collapse.hpp.
struct CollapsePlan {
  std::array<float, 8> cost{};            ///< cost[i - 1]: cost if collapsed to at most i subtrees
  std::array<std::uint8_t, 9> to_left{};  ///< to_left[i] is the number of the i subtrees that come
                                          ///< from the left child; 0: the same collapse as for i -
                                          ///< 1
  bool is_leaf = true;
};

/// A node with `count` references, whose ids start at BinaryTree::ids[begin].
struct BinaryNode {
  Box box;
  std::uint32_t begin = 0, count = 0, weight = 0;
  BinaryNode* children = nullptr;  ///< two consecutive nodes; null for a leaf
  CollapsePlan plan;
};

[[nodiscard]] inline bool is_instance(const BinaryNode& node) {
  return node.count == 1 && node.weight == kInstanceWeight;
}

/// Allocates nodes with stable addresses.
class NodeArena {
 public:
  /// Allocates two consecutive nodes and returns the first.
  [[nodiscard]] BinaryNode* allocate_pair();

  /// Calls f(node) for each node, newest first, so children come before their parents.
  template <class F>
  void for_each_backwards(F&& f) {
    for (std::size_t i = chunks_.size(); i-- > 0;) {
      for (std::size_t k = i + 1 == chunks_.size() ? used_ : kChunk; k-- > 0;) f(chunks_[i][k]);
    }
  }

 private:
  static constexpr std::size_t kChunk = 512;
  std::vector<std::unique_ptr<BinaryNode[]>> chunks_;
  std::size_t used_ = kChunk;
};

struct BinaryTree {
  BinaryNode root;
  NodeArena top;                    ///< nodes built by all threads together
  std::vector<NodeArena> subtrees;  ///< nodes built by one thread each
  PageVector<PrimitiveId> ids;
};

/// Splits the references until each leaf holds one kind of primitive and at most eight triangles or
/// one other primitive. The result depends only on the references and their order. `bins` is at
/// most kMaxBins.
[[nodiscard]] BinaryTree build_binary_tree(PageVector<Reference> references, int bins,
                                           WorkerPool& pool);

}  // namespace microtrace::build
