#pragma once
/// Finds the texels of points, for N lanes.

#include "render/lanes/texels.hpp"
#include "simd/vectors.hpp"

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// Two neighboring texels of a row or a column, and the interpolation weight of the second.
template <int N>
struct Between {
  Int<N> first, second;
  Float<N> share;
};

/// The texels between which a lookup interpolates.
template <int N>
struct TexelAddress {
  Int<N> level, columns;  ///< columns: width of the level
  Between<N> x, y;
};

/// The largest integers that are not greater than x. |x| must be less than 2^31.
template <int N>
Int<N> floor_of(const Float<N>& x) {
  const Int<N> whole = truncated<N>(x);
  return to_float<N>(whole) > x ? whole - 1 : whole;
}

/// Wraps coordinates to [0, 1].
template <int N>
Float<N> wrapped(const Float<N>& u, const TexelGrid::Axis& axis) {
  using F = Float<N>;
  // float32 has no fraction bits beyond this.
  const F inside = magnitude(u) < 0x1p22F ? u : F{};
  if (axis.is_repeated) return inside - to_float<N>(floor_of<N>(inside));
  if (axis.is_mirrored) {
    const F turn = inside - 2 * to_float<N>(floor_of<N>(F(inside * 0.5F)));
    return turn > 1 ? 2 - turn : turn;
  }
  return lesser(greater(inside, F{}), all<N>(1));
}

/// The texels that a bilinear filter reads at u in a level with `size` texels.
template <int N>
Between<N> linear_between(const Float<N>& u, const TexelGrid::Axis& axis, const Int<N>& size) {
  const Float<N> position = wrapped<N>(u, axis) * to_float<N>(size) - 0.5F;
  const Int<N> left = floor_of<N>(position), right = left + 1, last = size - 1;
  // Where a mirrored image meets its mirror image, the edge texels repeat, as with clamping.
  const Int<N> before = axis.is_repeated ? last : Int<N>{};
  const Int<N> after = axis.is_repeated ? Int<N>{} : last;
  const Int<N> first = left < 0 ? before : left;
  return {.first = lesser(first, last),
          .second = right >= size ? after : right,
          .share = position - to_float<N>(left)};
}

/// The texel that contains u.
template <int N>
Int<N> nearest_texel(const Float<N>& u, const TexelGrid::Axis& axis, const Int<N>& size) {
  const Float<N> position = wrapped<N>(u, axis) * to_float<N>(size);
  return lesser(truncated<N>(position), Int<N>(size - 1));
}

/// The texels of a bilinear lookup at (u, v) in the mip level whose texels are just smaller than
/// `width`. All three are given as fractions of the image's size.
template <int N>
TexelAddress<N> texel_address(const TexelGrid& grid, const Float<N>& u, const Float<N>& v,
                              const Float<N>& width) {
  const std::int32_t larger = grid.x.size > grid.y.size ? grid.x.size : grid.y.size;
  const Float<N> texels = width * static_cast<float>(larger);
  Int<N> level{};
  if (grid.last_level > 0) {
    // The exponent of a float is the integer part of its binary logarithm.
    const Int<N> exponent = (reinterpreted<Int<N>>(texels) >> 23) - 127;
    level = texels >= 2 ? lesser(exponent, Int<N>(Int<N>{} + grid.last_level)) : Int<N>{};
  }
  const auto size = [&](const TexelGrid::Axis& axis) {
    return greater(Int<N>((Int<N>{} + axis.size) >> level), Int<N>(Int<N>{} + 1));
  };
  const Int<N> columns = size(grid.x), rows = size(grid.y);
  TexelAddress<N> address{.level = level,
                          .columns = columns,
                          .x = linear_between<N>(u, grid.x, columns),
                          .y = linear_between<N>(v, grid.y, rows)};
  if (grid.is_nearest_magnified || grid.is_nearest_minified) {
    const Int<N> minified = Int<N>{} - std::int32_t{grid.is_nearest_minified};
    const Int<N> magnified = Int<N>{} - std::int32_t{grid.is_nearest_magnified};
    const auto is_nearest = (texels > 1 ? minified : magnified) != 0;
    const auto use = [&](const Int<N>& texel, Between<N>& between) {
      between = {.first = is_nearest ? texel : between.first,
                 .second = is_nearest ? texel : between.second,
                 .share = is_nearest ? Float<N>{} : between.share};
    };
    use(nearest_texel<N>(u, grid.x, columns), address.x);
    use(nearest_texel<N>(v, grid.y, rows), address.y);
  }
  return address;
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
