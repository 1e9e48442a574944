#pragma once
/// Adjacency of triangles.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace microtrace {

inline constexpr std::uint32_t kNoNeighbor = ~std::uint32_t{0};

/// Finds each triangle's neighbors across its three edges; kNoNeighbor where there is none. Edge k
/// leads from vertex k to the next. Two triangles are neighbors only if they traverse the shared
/// edge in opposite directions. If more than two triangles share an edge, earlier ones are paired
/// first. Each triangle must have three different vertices with indices below vertex_count. Takes
/// linear time unless vertices have very many edges.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> edge_neighbors(
    std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t vertex_count);

}  // namespace microtrace
