#pragma once
/// Functions to read and write the nodes and blocks of a Tree.

#include "accel/build/float4.hpp"
#include "accel/build/tree.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/shape.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace microtrace::build {

/// Returns a node without children.
[[nodiscard]] WideNode empty_node();

/// True if child i exists.
[[nodiscard]] inline bool has_child(const WideNode& node, std::size_t i) {
  return node.lo_x[i] <= node.hi_x[i];
}

void set_box(WideNode& node, std::size_t i, const Box& box);
[[nodiscard]] inline Box box_of_child(const WideNode& node, std::size_t i) {
  return Box{.lo = {node.lo_x[i], node.lo_y[i], node.lo_z[i], 0},
             .hi = {node.hi_x[i], node.hi_y[i], node.hi_z[i], 0}};
}
[[nodiscard]] Box union_of_children(const WideNode& node);
[[nodiscard]] Bounds bounds_of(const Box& box);

/// Returns the kind of a child: 0 (a node), child_ref::kTriangles, child_ref::kOthers, or
/// child_ref::kKind (an instance).
[[nodiscard]] inline ChildRef kind_of(ChildRef ref) {
  return ref & child_ref::kKind;
}

/// Fills a block, slot by slot.
class BlockFiller {
 public:
  /// Makes the block one without triangles.
  explicit BlockFiller(TriangleBlock& block);

  /// Adds a triangle. Returns false, without effect, if the block has no room for it. A block has
  /// room for at least five triangles, and for eight if they have at most fifteen vertices.
  bool add(PrimitiveId id, const Triangle& triangle);

 private:
  /// Returns the index of a vertex with the same bits, or vertices_.
  [[nodiscard]] unsigned find(const Vec3& vertex) const;

  TriangleBlock& block_;
  std::size_t slots_ = 0;
  unsigned vertices_ = 0;
};

/// Returns the triangle in a slot. The order of its vertices may differ from the scene's.
[[nodiscard]] inline Triangle triangle_in(const TriangleBlock& block, std::size_t slot) {
  const auto vertex = [&](int i) {
    return Vec3(coordinate(block, i, slot, 0), coordinate(block, i, slot, 1),
                coordinate(block, i, slot, 2));
  };
  return {.a = vertex(0), .b = vertex(1), .c = vertex(2)};
}

/// Returns the largest magnitude of a component.
template <class Vector>
[[nodiscard]] auto largest_component(const Vector& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// True if two blocks have the same bits for the vertices of all triangles.
[[nodiscard]] bool have_same_vertices(const TriangleBlock& a, const TriangleBlock& b);

}  // namespace microtrace::build
