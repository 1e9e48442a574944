#pragma once
/// Closed surfaces, and points on or near them.

#include "support/cases/adversarial_rays.hpp"

#include <microtrace/shape.hpp>

#include <string>
#include <vector>

namespace microtrace::adversarial {

struct SolidCase {
  std::string name;
  Mesh mesh;
  Vec3 center;
  float size;  ///< the surface lies about within center +- size
};

/// Returns `rounds` random bodies of each kind. They may be tiny, huge or far from the origin, and
/// some contain or overlap another body. Nested shells, touching cubes, slivers and a tetrahedron
/// follow.
[[nodiscard]] std::vector<SolidCase> solid_cases(Random& random, int rounds);

/// Returns a point that is on a vertex, an edge or a face as closely as float32 allows, a few ulps
/// away from one, or anywhere near the surface.
[[nodiscard]] Vec3 point_about(Random& random, const SolidCase& solid_case);

}  // namespace microtrace::adversarial
