#pragma once
/// Closed meshes of a few triangles, of any size and at any distance from the origin.

#include "support/cases/adversarial_rays.hpp"

#include <microtrace/shape.hpp>

#include <array>

namespace microtrace::adversarial {

enum class BodyKind {
  hull,         ///< the convex hull of random points
  prism,        ///< three to fifteen sides
  icosahedron,  ///< randomly rotated
  double_cone,  ///< two apexes, one on each side of a polygon
  star,         ///< a double cone whose rim alternates between two radii
  box,          ///< axis-aligned
  plate,        ///< a prism one to four ulps thick, often along an axis
  shell,        ///< the space between a body and a copy that is shifted by one to four ulps
};

inline constexpr std::array kBodyKinds = {
    BodyKind::hull, BodyKind::prism, BodyKind::icosahedron, BodyKind::double_cone,
    BodyKind::star, BodyKind::box,   BodyKind::plate,       BodyKind::shell};

[[nodiscard]] const char* name(BodyKind kind);

/// Returns a body of 4 to 64 triangles, or of twice as many for a shell. Each edge has an even
/// number of triangles, so a point is inside if a ray from it crosses an odd number of triangles.
/// Because of rounding, triangles may overlap or have no area.
[[nodiscard]] Mesh closed_body(Random& random, BodyKind kind, const Vec3& center, float size);

}  // namespace microtrace::adversarial
