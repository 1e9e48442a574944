#pragma once
#include "accel/build/tree.hpp"
#include "accel/layout.hpp"

#include <cstddef>
#include <memory>

namespace microtrace {

/// The growth of error bounds up to which triangles are joined, see few_triangles().
inline constexpr double kMostGrowth = 8;

/// Collects triangles of a tree.
class FewTrianglesBuilder {
 public:
  explicit FewTrianglesBuilder(const Tree& tree, double most_growth = kMostGrowth)
      : tree_(tree), most_growth_(most_growth) {}

  /// Adds the triangle in a slot of the tree's blocks unless it has been added. Returns false if
  /// there are too many triangles.
  [[nodiscard]] bool add(std::size_t slot);
  [[nodiscard]] std::size_t facets() const { return facets_; }
  [[nodiscard]] std::unique_ptr<const FewTriangles> finish() &&;

 private:
  const Tree& tree_;
  double most_growth_;
  std::unique_ptr<FewTriangles> triangles_ = std::make_unique<FewTriangles>();
  std::size_t facets_ = 0;
};

/// Returns the triangles of a tree; null if the tree has more than FewTriangles::kMost of them, or
/// other primitives. Joins pairs that form a parallelogram up to rounding, unless their
/// edge_product would exceed that of one of their triangles by more than `most_growth` times.
[[nodiscard]] std::unique_ptr<const FewTriangles> few_triangles(const Tree& tree,
                                                                double most_growth = kMostGrowth);

}  // namespace microtrace
