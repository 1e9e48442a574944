#pragma once
#include "accel/build/tree.hpp"
#include "accel/layout.hpp"

#include <memory>

namespace microtrace {

/// Returns the triangles of a tree; null if the tree has more than FewTriangles::kMost of them, or
/// other primitives. Joins pairs that form a parallelogram up to rounding, unless their
/// edge_product would exceed that of one of their triangles by more than `most_growth` times.
[[nodiscard]] std::unique_ptr<const FewTriangles> few_triangles(const Tree& tree,
                                                                double most_growth = 8);

}  // namespace microtrace
