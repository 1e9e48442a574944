#pragma once
/// Interpolation in tables, for N lanes.

#include "simd/transpose.hpp"

namespace microtrace::bsdf {

/// A position between two entries of a table. Positions beyond the table, which may occur in unused
/// lanes, are clamped.
template <int N>
struct Cell {
  Int<N> first;
  Float<N> share;

  /// The position `step`, counted in entries, in a table with `count` entries.
  Cell(const Float<N>& step, int count) {
    const Float<N> last = all<N>(static_cast<float>(count - 2));
    const Float<N> within = step > 0 ? step : Float<N>{};
    first = truncated<N>(within < last ? within : last);
    share = step - to_float<N>(first);
  }
  [[nodiscard]] Float<N> mixed(const Float<N>& a, const Float<N>& b) const {
    return a + share * (b - a);
  }
};

/// Loads four numbers for each lane. One load per lane is faster than a gather per number.
template <int N>
struct Quad {
  Float<N> values[4];

  Quad(const float* quads, const Int<N>& index) {
    std::uint32_t indices[N];
    __builtin_memcpy(indices, &index, sizeof index);
    load_rows<N>(quads, indices, values);
  }
};

/// Interpolates in a table of `columns` entries per row, of which `cells` has the corners of each
/// cell; see cells_of() in tables/tables.cpp.
template <int N>
Float<N> interpolated(const float* cells, int columns, const Cell<N>& row, const Cell<N>& column) {
  const auto& [v] = Quad<N>(cells, row.first * (columns - 1) + column.first);
  return row.mixed(column.mixed(v[0], v[1]), column.mixed(v[2], v[3]));
}

}  // namespace microtrace::bsdf
