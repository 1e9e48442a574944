#pragma once
/// Closed meshes, and rays aimed exactly at their corners and edges.

#include "support/adversarial_rays.hpp"

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <vector>

namespace microtrace::adversarial {

struct ClosedMesh {
  const char* name;
  Mesh mesh;
  Vec3 centre;    ///< within
  float radius;   ///< of a ball within, about it
  float spacing;  ///< of the grid on which all corners are
};

/// A few triangles and many, walls within one plane, long thin ones, and a mesh far from the
/// origin.
[[nodiscard]] std::vector<ClosedMesh> closed_meshes();

/// A ray from o exactly at a corner, or at one of the fifteen points that cut an edge into sixteen
/// parts; o on the grid.
[[nodiscard]] Ray aimed_exactly(Random& random, const ClosedMesh& closed, const Vec3& o);

}  // namespace microtrace::adversarial
