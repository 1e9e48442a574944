#include "accel/large_triangles.hpp"

#include "accel/build/area.hpp"
#include "accel/build/references/shape_box.hpp"
#include "accel/build/wide/wide_tree.hpp"
#include "accel/few_triangles.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace microtrace {
namespace {

/// The fractions of the surface of all that the box of a large triangle has at least. The first one
/// is used with which the triangles are few.
constexpr float kLeastAreas[] = {1.0F / 512, 1.0F / 128, 1.0F / 32};
/// Few enough for FewTrianglesWalk to be fast with the kernels of all instruction sets.
constexpr std::size_t kMostFacets = 16;
constexpr std::size_t kMostNodes = std::size_t{1} << 13U;

class Collector {
 public:
  Collector(const Tree& tree, float least_area)
      : tree_(tree),
        measure_(box_of(tree.bounds)),
        least_(least_area * measure_(box_of(tree.bounds))),
        builder_(tree) {}

  LargeTriangles collect() && {
    LargeTriangles result{.triangles = nullptr, .rest = {tree_.nodes.begin(), tree_.nodes.end()}};
    nodes_ = result.rest;
    const build::Box others = prune(tree_.root);
    for (int axis = 0; axis < 3; ++axis) {
      result.bounds.lo[axis] = others.lo[axis];
      result.bounds.hi[axis] = others.hi[axis];
    }
    if (builder_.facets() == 0 || builder_.facets() > kMostFacets || failed_) return {};
    result.triangles = std::move(builder_).finish();
    return result;
  }

 private:
  static build::Box box_of(const Bounds& bounds) {
    const auto& [lo, hi] = bounds;
    return build::Box{.lo = build::Float4{lo.x, lo.y, lo.z, 0},
                      .hi = build::Float4{hi.x, hi.y, hi.z, 0}};
  }

  /// Removes the leaves below a node that have only large triangles. Returns the box of the others.
  build::Box prune(std::size_t number) {
    WideNode& node = nodes_[number];
    for (std::size_t i = 0; i < kWidth; ++i) {
      if (!build::has_child(node, i)) continue;
      const ChildRef child = node.child[i];
      if (build::kind_of(child) == 0) {
        build::set_box(node, i, prune(child));
      } else if (build::kind_of(child) == child_ref::kTriangles && takes(child)) {
        build::set_box(node, i, build::Box{});
      }
    }
    return build::union_of_children(node);
  }

  /// Adds the triangles of a leaf if all are large. Returns false if they are not.
  bool takes(ChildRef leaf) {
    const auto blocks = entries_of(leaf);
    const auto each = [&](const auto& f) {
      for (std::size_t slot = std::size_t{blocks.begin} * kWidth;
           slot < std::size_t{blocks.end} * kWidth; ++slot) {
        if (is_used(tree_.blocks[slot / kWidth], slot % kWidth) && !f(slot)) return false;
      }
      return true;
    };
    if (failed_ || !each([&](std::size_t slot) { return is_large(slot); })) return false;
    failed_ = !each([&](std::size_t slot) { return builder_.add(slot); });
    return !failed_;
  }

  [[nodiscard]] bool is_large(std::size_t slot) const {
    return measure_(build::box_of(
               build::triangle_in(tree_.blocks[slot / kWidth], slot % kWidth))) >= least_;
  }

  const Tree& tree_;
  build::AreaMeasure measure_;
  float least_;
  FewTrianglesBuilder builder_;
  std::span<WideNode> nodes_;
  bool failed_ = false;
};

}  // namespace

LargeTriangles large_triangles(const Tree& tree) {
  if (tree.blocks.empty() || build::kind_of(tree.root) != 0 || tree.nodes.size() > kMostNodes)
    return {};
  for (const float least_area : kLeastAreas) {
    LargeTriangles result = Collector(tree, least_area).collect();
    if (result.triangles) return result;
  }
  return {};
}

}  // namespace microtrace
