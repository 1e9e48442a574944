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

/// Quadratic Lagrange interpolation at x between three neighboring nodes out of n equidistant nodes
/// in [0, 1].
template <int N>
struct Parabola {
  Int<N> first;
  Float<N> weights[3];

  Parabola(const Float<N>& x, int n) {
    const Float<N> step = x * static_cast<float>(n - 1);
    // `step` is not negative, and ties may round either way.
    // NOLINTNEXTLINE(bugprone-incorrect-roundings)
    const Int<N> nearest = truncated<N>(step + 0.5F);
    const Int<N> least = Int<N>{} + 1, last = Int<N>{} + (n - 3);
    const Int<N> before = larger_of(nearest, least) - 1;
    first = smaller_of(before, last);
    const Float<N> p = step - to_float<N>(first);
    weights[0] = (p - 1) * (p - 2) * 0.5F;
    weights[1] = p * (2 - p);
    weights[2] = p * (p - 1) * 0.5F;
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
