#pragma once
#include "accel/build/tree.hpp"
#include "accel/layout.hpp"

#include <memory>

namespace microtrace {

/// Returns the triangles of a tree; null if the tree has more than FewTriangles::kMost of them, or
/// other primitives.
[[nodiscard]] std::unique_ptr<const FewTriangles> few_triangles(const Tree& tree);

}  // namespace microtrace
