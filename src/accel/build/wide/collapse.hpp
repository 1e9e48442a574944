#pragma once
/// Collapses a binary tree to nodes with up to eight children, such that the expected cost of a ray
/// is minimal. After H. Ylitie, T. Karras, S. Laine, Efficient incoherent ray traversal on GPUs
/// through compressed wide BVHs, 2017, section 3.2.

#include "accel/build/area.hpp"
#include "accel/build/binary/binary_tree.hpp"

namespace microtrace::build {

/// The costs of testing a node's children and of testing a block of triangles.
inline constexpr float kNodeCost = 0.6F;
inline constexpr float kBlockCost = 1;
/// The cost of entering an instance. All trees contain the same instances, so only the cost of
/// nodes above them matters.
inline constexpr float kInstanceCost = 8;

/// What the costs of all nodes of a tree depend on.
struct CollapseModel {
  AreaMeasure area{Box()};
  std::uint32_t triangle_weight = kTriangleWeight;  ///< see References
};

/// Computes the costs of a node without children.
[[nodiscard]] CollapseCosts costs_of_leaf(const BinaryNode& node, const CollapseModel& model);

/// Computes the plan and the costs of a node whose children have these costs.
[[nodiscard]] CollapseCosts plan_collapse(BinaryNode& node, const CollapseModel& model,
                                          const CollapseCosts& left, const CollapseCosts& right);

/// The children of a wide node: at most eight subtrees that together contain all of a binary node.
class WideChildren {
 public:
  explicit WideChildren(const BinaryNode& node);
  [[nodiscard]] const BinaryNode* const* begin() const { return children_.data(); }
  [[nodiscard]] const BinaryNode* const* end() const { return children_.data() + count_; }
  [[nodiscard]] const BinaryNode& operator[](std::size_t i) const { return *children_[i]; }
  [[nodiscard]] std::size_t size() const { return count_; }

 private:
  void cut(const BinaryNode& node, unsigned parts);

  std::array<const BinaryNode*, 8> children_{};
  std::size_t count_ = 0;
};

}  // namespace microtrace::build
