#pragma once
/// From a binary tree to one of nodes with up to eight children, at the least expected cost for a
/// ray: H. Ylitie, T. Karras, S. Laine, Efficient incoherent ray traversal on GPUs through
/// compressed wide BVHs, 2017, section 3.2.

#include "accel/build/area.hpp"
#include "accel/build/binary_tree.hpp"

namespace microtrace::build {

/// What a ray pays for a node that it enters, and for a block of triangles.
inline constexpr float kNodeCost = 0.6F;
inline constexpr float kBlockCost = 1;

/// Plans a node whose children have been planned.
void plan_collapse(BinaryNode& node, const AreaMeasure& area);

/// The children of a wide node: at most eight subtrees that together are the given one.
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
