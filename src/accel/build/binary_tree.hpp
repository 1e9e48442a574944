#pragma once
/// The tree before its nodes become wide.

#include "accel/build/reference.hpp"
#include "accel/build/worker_pool.hpp"

#include <array>
#include <memory>

namespace microtrace::build {

/// What is best for a node and all below it; see collapse.hpp.
struct CollapsePlan {
  std::array<float, 8> cost{};            ///< [i - 1]: as at most i subtrees
  std::array<std::uint8_t, 9> to_left{};  ///< [i]: how many of the i go left; 0: as for i - 1
  bool is_leaf = true;
};

/// `count` references from `begin` on, in the order of BinaryTree::ids.
struct BinaryNode {
  Box box;
  std::uint32_t begin = 0, count = 0, weight = 0;
  BinaryNode* children = nullptr;  ///< two, one after the other; none: a leaf
  CollapsePlan plan;
};

/// Hands out nodes that stay where they are.
class NodeArena {
 public:
  /// Two nodes side by side.
  [[nodiscard]] BinaryNode* allocate_pair();

  /// f(node) for each, the youngest first: children before their parents.
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
  NodeArena top;                    ///< where all threads worked together
  std::vector<NodeArena> subtrees;  ///< where each worked alone
  PageVector<PrimitiveId> ids;
};

/// Splits down to leaves of one kind of primitive and at most eight of them. Takes the references'
/// memory. The result depends on nothing but their order. `bins` is at most kMaxBins.
[[nodiscard]] BinaryTree build_binary_tree(PageVector<Reference> references, int bins,
                                           WorkerPool& pool);

}  // namespace microtrace::build
