#pragma once
/// Merges equal vertices.

#include <microtrace/math.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace microtrace {

/// Returns for each vertex the first vertex with equal position, normal and texture coordinates.
/// All numbers must be finite, and the spans must have equal sizes. Takes linear time.
[[nodiscard]] std::vector<std::uint32_t> welded(std::span<const Vec3> positions,
                                                std::span<const Vec3> normals,
                                                std::span<const Vec2> uv);

}  // namespace microtrace
