#pragma once
/// Vertices that are one.

#include <microtrace/math.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace microtrace {

/// For each vertex the first one with the same position, normal and texture coordinates, number for
/// number. All finite, and as many of each. In linear time.
[[nodiscard]] std::vector<std::uint32_t> welded(std::span<const Vec3> positions,
                                                std::span<const Vec3> normals,
                                                std::span<const Vec2> uv);

}  // namespace microtrace
