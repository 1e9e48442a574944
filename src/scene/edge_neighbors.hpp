#pragma once
/// Triangles that lie edge to edge.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace microtrace {

inline constexpr std::uint32_t kNoNeighbor = ~std::uint32_t{0};

/// For each triangle the ones beyond its three edges, of which edge k leads from corner k to the
/// next, or kNoNeighbor. Two that are neighbours have an edge's vertices in opposite order. Of more
/// than two at one edge, the earlier ones are paired first. Each triangle has three different
/// vertices below vertex_count. In linear time but for vertices of very many edges.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> edge_neighbors(
    std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t vertex_count);

}  // namespace microtrace
