#include "accel/build/instances/scene_box.hpp"

#include "accel/build/references/shape_box.hpp"
#include "accel/build/wide/wide_tree.hpp"
#include "accel/instances/dispatch.hpp"

#include <microtrace/primitives.hpp>

#include <array>
#include <vector>

namespace microtrace::build {
namespace {

bool contains(const Box& outer, const Box& inner) {
  const Int4 is_outside = (inner.lo < outer.lo) | (outer.hi < inner.hi);
  return (is_outside[0] | is_outside[1] | is_outside[2]) == 0;
}

class BoxFinder {
 public:
  BoxFinder(const Instance& instance, const Tree& tree, const PlacedMesh& mesh)
      : instance_(instance), tree_(tree), mesh_(mesh) {}

  Box run() {
    // Most of a large tree is inside a box around the leaves that reach farthest along each axis.
    constexpr std::size_t kFewBlocks = 6;
    for (int axis = 0; axis < 3 && tree_.blocks.size() > kFewBlocks; ++axis) {
      descend(axis, false);
      descend(axis, true);
    }
    open_.push_back(tree_.root);
    while (!open_.empty()) {
      const ChildRef next = open_.back();
      open_.pop_back();
      if (kind_of(next) != 0) {
        add_leaf(next);
        continue;
      }
      const WideNode node = placed(next);
      for (std::size_t i = 0; i < kWidth; ++i)
        if (has_child(node, i) && !contains(box_, box_of_child(node, i)))
          open_.push_back(node.child[i]);
    }
    return box_;
  }

 private:
  [[nodiscard]] WideNode placed(ChildRef node) const {
    WideNode result;
    kernels_.scene_node(instance_, tree_.nodes[node], result);
    return result;
  }

  /// Adds the leaf below the children that reach farthest in one direction.
  void descend(int axis, bool is_up) {
    ChildRef next = tree_.root;
    while (kind_of(next) == 0) {
      const WideNode node = placed(next);
      std::size_t farthest = 0;
      for (std::size_t i = 1; i < kWidth; ++i) {
        if (!has_child(node, i)) continue;
        const Box a = box_of_child(node, i), b = box_of_child(node, farthest);
        if (is_up ? a.hi[axis] > b.hi[axis] : a.lo[axis] < b.lo[axis]) farthest = i;
      }
      next = node.child[farthest];
    }
    add_leaf(next);
  }

  void add_leaf(ChildRef leaf) {
    const auto [begin, end] = entries_of(leaf);
    for (std::size_t k = begin; k < end; ++k) {
      if (kind_of(leaf) != child_ref::kTriangles) {
        box_.include(box_of(triangle_of(mesh_, tree_.others[k])));
        continue;
      }
      TriangleBlock block;
      kernels_.scene_block(instance_, tree_.blocks[k], block);
      for (std::size_t i = 0; i < kWidth && is_used(block, i); ++i)
        box_.include(box_of(triangle_in(block, i)));
    }
  }

  const Instance& instance_;
  const Tree& tree_;
  const PlacedMesh& mesh_;
  const InstanceKernels& kernels_ = kInstanceKernels.best();
  Box box_;
  std::vector<ChildRef> open_;
};

}  // namespace

Box scene_box(const Instance& instance, const Tree& tree, const PlacedMesh& mesh) {
  return BoxFinder(instance, tree, mesh).run();
}

}  // namespace microtrace::build
