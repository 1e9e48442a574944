#pragma once
/// Reads a tree in scene coordinates, for traversals that are not worth a kernel of their own.

#include "accel/build/tree.hpp"
#include "accel/instances/dispatch.hpp"
#include "accel/layout.hpp"

#include <microtrace/hit.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace microtrace {

/// Gives access to the nodes and leaves of a tree and, after enter(), to those of an instance,
/// whose nodes and blocks it transforms to the scene. Results are valid until the next call.
class TreeReader {
 public:
  explicit TreeReader(const Tree& tree) : tree_(tree) {}

  /// If the reference is an instance, enters it, replaces the reference by the root of its mesh's
  /// tree and returns true. The traversal must visit kInstanceEnd after the subtrees of the mesh.
  [[nodiscard]] bool enter(ChildRef& next) {
    if (next < child_ref::kFirstInstance || next > child_ref::kLastInstance) return false;
    if (kernels_ == nullptr) kernels_ = &kInstanceKernels.best();
    instance_ = &tree_.instances[next - child_ref::kFirstInstance];
    mesh_ = &tree_.views[instance_->mesh];
    next = mesh_->root;
    return true;
  }
  /// If the reference is kInstanceEnd, leaves the instance and returns true.
  [[nodiscard]] bool leave(ChildRef next) {
    if (next != child_ref::kInstanceEnd) return false;
    instance_ = nullptr;
    return true;
  }

  [[nodiscard]] const WideNode& node(ChildRef node) {
    if (instance_ == nullptr) return tree_.nodes[node];
    if (!node_) node_.emplace();
    kernels_->scene_node(*instance_, mesh_->nodes[node], *node_);
    enlarge(*node_, instance_->reach);
    return *node_;
  }
  [[nodiscard]] const TriangleBlock& block(std::uint32_t block) {
    if (instance_ == nullptr) return tree_.blocks[block];
    kernels_->scene_block(*instance_, mesh_->blocks[block], block_ ? *block_ : block_.emplace());
    return *block_;
  }
  [[nodiscard]] PrimitiveId other(std::uint32_t other) const {
    if (instance_ == nullptr) return tree_.others[other];
    return instance_->first_id + mesh_->others[other];
  }

 private:
  /// Boxes of scene_node contain the vertices of their triangles, but not always the points between
  /// them: the tree splits large triangles, and the triangle of the rounded vertices may leave the
  /// image of a part's box. With the rounding errors e_j of inner_ray.hpp, it leaves the exact
  /// image by at most e_j, the image is rounded with an error of at most e_j, and so is the result
  /// here. `reach` exceeds 1.2 e_j.
  static void enlarge(WideNode& node, float reach) {
    for (float* const lo : {node.lo_x, node.lo_y, node.lo_z})
      for (int i = 0; i < kWidth; ++i) lo[i] -= 3 * reach;
    for (float* const hi : {node.hi_x, node.hi_y, node.hi_z})
      for (int i = 0; i < kWidth; ++i) hi[i] += 3 * reach;
  }

  const Tree& tree_;
  const InstanceKernels* kernels_ = nullptr;  // found when an instance is entered
  const Instance* instance_ = nullptr;        // null in the scene's own tree
  const MeshTree* mesh_ = nullptr;            // of the instance
  std::optional<WideNode> node_;  // made for the first node of an instance, as most trees have none
  std::optional<TriangleBlock> block_;
};

/// The number of references on the stack of a depth-first traversal.
inline constexpr std::size_t kTraversalStack =
    2 * (std::size_t{kMaxDepth} * (kWidth - 1) + kWidth) + 1;

}  // namespace microtrace
