#pragma once
#include "queries/selection.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/queries.hpp>

#include <vector>

namespace microtrace {

/// The edges of an odd number of the selected triangles, in the order of their triangles and sides;
/// vertices at equal positions are one vertex. Positions are in scene coordinates. An edge between
/// equal vertices doesn't count.
[[nodiscard]] std::vector<OpenEdge> open_edges(const Primitives& primitives, Selection selection);

}  // namespace microtrace
