#pragma once
/// The hemisphere about a coordinate axis, for N lanes. It is divided into bins of equal solid
/// angle: rows of equal height, and columns of equal longitude.

#include "render/lanes/guide_lanes.hpp"
#include "simd/revolutions.hpp"
#include "simd/vector3.hpp"

namespace microtrace {

inline namespace MICROTRACE_KERNELS {

/// Twice the number of the coordinate axis from which a vector deviates least, plus 1 if the vector
/// points against the axis.
template <int N>
Int<N> nearest_face(const Floats3<N>& n) {
  const Int<N> x{}, y = x + 1, z = x + 2;
  const Floats3<N> size = magnitudes(n);
  const Int<N> axis = size.x >= size.y ? (size.x >= size.z ? x : z) : (size.y >= size.z ? y : z);
  const Float<N> along = axis == 0 ? n.x : (axis == 1 ? n.y : n.z);
  return 2 * axis + (along < 0 ? Int<N>{} + 1 : Int<N>{});
}

template <int N>
struct HemisphereLanes {
  using F = Float<N>;
  using I = Int<N>;
  using V = Floats3<N>;
  static constexpr int kRows = HemisphereGrid::kRows, kColumns = HemisphereGrid::kColumns;

  I axis;  ///< 0 to 2
  F sign;  ///< -1 for the negative direction of the axis, otherwise 1

  /// The unit direction at a position in rows and columns. Uniform positions give uniform
  /// directions.
  [[nodiscard]] V direction(const F& row, const F& column) const {
    const F height = row / kRows;
    const auto turn = sin_cos_revolutions<N>(column / kColumns);
    const F range = square_root<N>((1 - height) * (1 + height));
    const F h = sign * height, c = range * turn.cosine, s = range * turn.sine;
    return {axis == 0 ? h : (axis == 1 ? s : c), axis == 1 ? h : (axis == 2 ? s : c),
            axis == 2 ? h : (axis == 0 ? s : c)};
  }

  struct Place {
    I bin;          ///< row * kColumns + column; -1 below the hemisphere
    F row, column;  ///< the position within the bin, in [0, 1]
  };
  /// The inverse of direction().
  [[nodiscard]] Place place(const V& d) const {
    const F height = sign * (axis == 0 ? d.x : (axis == 1 ? d.y : d.z));
    const F c = axis == 0 ? d.y : (axis == 1 ? d.z : d.x);
    const F s = axis == 0 ? d.z : (axis == 1 ? d.x : d.y);
    const F turn = atan2_revolutions<N>(s, c);
    const auto is_above = height > 0;
    const F y = is_above ? height * kRows : F{};
    const F x = chosen<N>(turn < 0, turn + 1, turn) * kColumns;
    const I row = smaller_of(truncated<N>(y), I{} + (kRows - 1));
    const I column = smaller_of(truncated<N>(x), I{} + (kColumns - 1));
    return {is_above ? row * kColumns + column : I{} - 1, y - to_float<N>(row),
            x - to_float<N>(column)};
  }
};

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
