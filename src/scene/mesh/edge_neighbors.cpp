#include "scene/mesh/edge_neighbors.hpp"

#include <algorithm>
#include <cstddef>

namespace microtrace {
namespace {

/// An edge of a triangle. It is stored in the list of its vertex with the lesser index.
struct Edge {
  std::uint32_t greater;  ///< the vertex with the greater index
  std::uint32_t corner;   ///< 3 * triangle + edge
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> edge_neighbors(
    std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t vertex_count) {
  const auto begin_of = [&](std::uint32_t corner) { return triangles[corner / 3][corner % 3]; };
  const auto end_of = [&](std::uint32_t corner) { return triangles[corner / 3][(corner + 1) % 3]; };
  const auto corner_count = static_cast<std::uint32_t>(3 * triangles.size());

  // Sorts edges by lesser vertex (counting sort).
  std::vector<std::uint32_t> first(vertex_count + 1);
  for (std::uint32_t corner = 0; corner < corner_count; ++corner) {
    ++first[std::min(begin_of(corner), end_of(corner)) + 1];
  }
  for (std::size_t v = 0; v < vertex_count; ++v) first[v + 1] += first[v];
  std::vector<Edge> edges(corner_count);
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t corner = 0; corner < corner_count; ++corner) {
    const auto [lesser, greater] = std::minmax({begin_of(corner), end_of(corner)});
    edges[next[lesser]++] = {.greater = greater, .corner = corner};
  }

  std::vector<std::array<std::uint32_t, 3>> result(triangles.size(),
                                                   {kNoNeighbor, kNoNeighbor, kNoNeighbor});
  // Unpaired edges between the same two vertices, all in the same direction.
  std::vector<std::uint32_t> waiting;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const std::span<Edge> here(edges.data() + first[v], edges.data() + first[v + 1]);
    std::ranges::sort(here, [](const Edge& a, const Edge& b) {
      return a.greater != b.greater ? a.greater < b.greater : a.corner < b.corner;
    });
    std::size_t served = 0;
    for (std::size_t i = 0; i < here.size(); ++i) {
      if (i == 0 || here[i].greater != here[i - 1].greater) waiting.clear(), served = 0;
      const std::uint32_t corner = here[i].corner;
      if (served == waiting.size() || begin_of(waiting[served]) == begin_of(corner)) {
        waiting.push_back(corner);
        continue;
      }
      const std::uint32_t other = waiting[served++];
      result[corner / 3][corner % 3] = other / 3;
      result[other / 3][other % 3] = corner / 3;
    }
  }
  return result;
}

}  // namespace microtrace
