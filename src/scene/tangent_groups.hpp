#pragma once
/// Which corners of triangles share a tangent, and what that is.

#include <microtrace/math.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace microtrace {

/// A mesh with smooth normals, of as many positions, normals and texture coordinates.
struct TangentSource {
  std::span<const Vec3> positions, normals;
  std::span<const Vec2> uv;
  std::span<const std::array<std::uint32_t, 3>> triangles;
};

/// The tangents of all triangles' corners, three by three, as make_tangents says. Equal ones of a
/// vertex have equal bits.
[[nodiscard]] std::vector<Vec4> corner_tangents(const TangentSource& mesh);

/// Any direction across the normal, of unit length, with w = 1.
[[nodiscard]] Vec4 tangent_across(const Vec3& normal);

}  // namespace microtrace
