#pragma once
/// Closed meshes, and rays that are aimed exactly at their vertices and edges.

#include "support/cases/adversarial_rays.hpp"

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <vector>

namespace microtrace::adversarial {

struct ClosedMesh {
  const char* name;
  Mesh mesh;
  Vec3 center;    ///< a point inside the mesh
  float radius;   ///< a ball around `center` with this radius is inside the mesh
  float spacing;  ///< all vertices are at multiples of this number
};

/// Meshes with few and with many triangles, with coplanar walls, with long thin triangles, and far
/// from the origin.
[[nodiscard]] std::vector<ClosedMesh> closed_meshes();

/// Returns a ray from o that is aimed exactly at a vertex, or at one of the fifteen points that
/// divide an edge into sixteen equal parts. `o` must be on the grid.
[[nodiscard]] Ray aimed_exactly(Random& random, const ClosedMesh& closed, const Vec3& o);

}  // namespace microtrace::adversarial
