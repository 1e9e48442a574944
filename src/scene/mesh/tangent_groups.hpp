#pragma once
/// Groups the corners of triangles that share a tangent, and computes the tangents.

#include <microtrace/math.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace microtrace {

/// A mesh with smooth normals. The spans of positions, normals and texture coordinates have equal
/// sizes.
struct TangentSource {
  std::span<const Vec3> positions, normals;
  std::span<const Vec2> uv;
  std::span<const std::array<std::uint32_t, 3>> triangles;
};

/// The tangents of all corners, three per triangle, as defined by make_tangents. If corners at a
/// vertex share a tangent, their results have equal bits.
[[nodiscard]] std::vector<Vec4> corner_tangents(const TangentSource& mesh);

/// An arbitrary unit direction perpendicular to the normal, with w = 1.
[[nodiscard]] Vec4 tangent_across(const Vec3& normal);

}  // namespace microtrace
