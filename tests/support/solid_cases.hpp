#pragma once
/// Closed surfaces, and points on and beside them.

#include "support/adversarial_rays.hpp"

#include <microtrace/shape.hpp>

#include <string>
#include <vector>

namespace microtrace::adversarial {

struct SolidCase {
  std::string name;
  Mesh mesh;
  Vec3 center;
  float size;  ///< the surface is about in the cube center +- size
};

/// `rounds` random bodies of each kind, tiny, huge, far from the origin, some with another body
/// within or across; then nested shells, touching cubes, slivers and a tetrahedron.
[[nodiscard]] std::vector<SolidCase> solid_cases(Random& random, int rounds);

/// A point on a vertex, on an edge or on a face, as far as float32 allows, a few ulps beside them,
/// or anywhere about the surface.
[[nodiscard]] Vec3 point_about(Random& random, const SolidCase& solid_case);

}  // namespace microtrace::adversarial
