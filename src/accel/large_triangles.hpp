#pragma once
#include "accel/build/tree.hpp"
#include "accel/layout.hpp"

#include <memory>
#include <vector>

namespace microtrace {

/// The large triangles of a tree, such as those of walls, and the tree without the leaves that have
/// no others. Most rays of a room would enter the boxes of such triangles, so they are tested
/// without traversal.
struct LargeTriangles {
  std::unique_ptr<const FewTriangles> triangles;  ///< null if there are none
  std::vector<WideNode> rest;                     ///< nodes of the tree without these leaves
  FewTriangles::Box bounds{};                     ///< of the other leaves
};

/// Returns the large triangles if they are few. There are none in a tree that is small enough for
/// few_triangles(), or so large that the copy of its nodes would take much memory.
[[nodiscard]] LargeTriangles large_triangles(const Tree& tree);

}  // namespace microtrace
