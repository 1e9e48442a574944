#pragma once
/// Maps pairs of random numbers to directions and points, in float32 with only + - * / and sqrt,
/// for N lanes.

#include "simd/vector3.hpp"
#include "simd/vectors.hpp"

#include <microtrace/math.hpp>

namespace microtrace::sampling {

/// Rescales u from the interval [begin, begin + share), which it has selected, to [0, 1) for reuse.
/// The result is below 1 despite rounding.
template <int N = 1>
Float<N> reused(const Float<N>& u, const Float<N>& begin, const Float<N>& share) {
  return smaller_of((u - begin) / share, all<N>(0x1.fffffep-1F));
}

/// Cosine and sine of an angle.
template <int N>
struct UnitPair {
  Float<N> cosine, sine;
};

/// Cosine and sine of u revolutions, u in [0, 1]. Errors are below 2^-22.
template <int N = 1>
UnitPair<N> unit_pair(const Float<N>& u) {
  using F = Float<N>;
  const Int<N> quarter = truncated<N>(4 * u + 0.5F);
  const F x = (u - to_float<N>(quarter) * 0.25F) * 6.28318530717958648F;  // in [-pi/4, pi/4]
  const F z = x * x;
  // Taylor polynomials. The first omitted term is below 2^-23.
  const F s = x + x * z * (-1 / 6.0F + z * (1 / 120.0F - z * (1 / 5040.0F)));
  const F c = 1 - z * (0.5F - z * (1 / 24.0F - z * (1 / 720.0F - z * (1 / 40320.0F))));
  const auto swaps = (quarter & 1) != 0, is_second_half = (quarter & 2) != 0;
  const F cosine = swaps ? -s : c, sine = swaps ? c : s;
  return {is_second_half ? -cosine : cosine, is_second_half ? -sine : sine};
}

/// A point that is uniformly distributed over the unit disk.
template <int N = 1>
Floats2<N> unit_disk(const Floats2<N>& u) {
  const auto [cosine, sine] = unit_pair<N>(u.x);
  const Float<N> r = square_root<N>(u.y);
  return {r * cosine, r * sine};
}

/// A direction around +z with the pdf cos(theta) / pi, above a point of the unit disk.
template <int N = 1>
Floats3<N> cosine_hemisphere(const Floats2<N>& u) {
  const Floats2<N> p = unit_disk<N>(u);
  return {p.x, p.y, square_root<N>(1 - u.y)};
}

/// The weights of a triangle's first two vertices for a point that is uniformly distributed over
/// its area (E. Heitz, A low-distortion map between triangle and square, 2019).
template <int N = 1>
Floats2<N> triangle_weights(const Floats2<N>& u) {
  const auto is_upper = u.y > u.x;
  return {is_upper ? u.x * 0.5F : u.x - u.y * 0.5F, is_upper ? u.y - u.x * 0.5F : u.y * 0.5F};
}

/// The barycentric coordinates of the point with these triangle_weights().
template <int N = 1>
Floats3<N> triangle_point(const Floats2<N>& u) {
  const Floats2<N> w = triangle_weights<N>(u);
  return {w.x, w.y, larger_of(Float<N>(1 - w.x - w.y), Float<N>{})};
}

}  // namespace microtrace::sampling
