#pragma once
/// Closed meshes, and rays aimed exactly at their vertices and edges.

#include "support/adversarial_rays.hpp"

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <vector>

namespace microtrace::adversarial {

struct ClosedMesh {
  const char* name;
  Mesh mesh;
  Vec3 center;    ///< inside
  float radius;   ///< of a ball around `center` that is inside the mesh
  float spacing;  ///< of the grid of all vertices
};

/// Few triangles and many, walls in one plane, long thin triangles, and a mesh far from the origin.
[[nodiscard]] std::vector<ClosedMesh> closed_meshes();

/// A ray from o exactly at a vertex, or at one of the fifteen points that divide an edge into
/// sixteen parts; o must be on the grid.
[[nodiscard]] Ray aimed_exactly(Random& random, const ClosedMesh& closed, const Vec3& o);

}  // namespace microtrace::adversarial
