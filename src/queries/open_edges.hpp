#pragma once
#include "queries/selection.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/queries.hpp>

#include <vector>

namespace microtrace {

/// Returns the edges that belong to an odd number of the selected triangles, ordered by triangle
/// and side. Vertices at equal positions count as one vertex, and an edge between equal vertices
/// doesn't count. Positions are in scene coordinates.
[[nodiscard]] std::vector<OpenEdge> open_edges(const Primitives& primitives, Selection selection);

}  // namespace microtrace
