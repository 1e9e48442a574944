#pragma once
/// Interpolates positions and attributes on triangles in float64, for N lanes.

#include "simd/vector3.hpp"

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

inline constexpr double kGreatestDouble = 0x1.fffffffffffffp+1023;

template <int N>
struct TriangleCorners {
  Doubles3<N> a, b, c;
};

/// A vector that exists only in some lanes.
template <int N, class Mask>
struct Maybe3 {
  Doubles3<N> v;
  Mask exists;
};

/// The normalized v; none if v is zero. The square of the length can't overflow for float32 input.
template <int N>
inline auto direction_of(const Doubles3<N>& v) {
  const Double<N> square = dot(v, v);
  const auto exists = (square > 0) & (square <= kGreatestDouble);
  return Maybe3<N, decltype(exists)>{v / square_root<N>(square), exists};
}

/// The normal of the front side. Its length is twice the triangle's area.
template <int N>
inline Doubles3<N> area_vector(const TriangleCorners<N>& t) {
  return cross(t.b - t.a, t.c - t.a);
}

/// Barycentric coordinates of the point where the ray meets the triangle's plane (T. Moeller and B.
/// Trumbore, Fast, minimum storage ray/triangle intersection, 1997). They exist if the triangle has
/// an area and is neither seen nearly edge-on nor extremely far away: each term of the determinant
/// has at most six roundings and is at most the product of the three sums, so the relative error of
/// the determinant is then below 2^-26, and its sign is certain. Likewise, the errors of the
/// coordinates are then below 2^-11.
template <int N>
inline auto barycentrics_of(const TriangleCorners<N>& t, const Doubles3<N>& o,
                            const Doubles3<N>& d) {
  using D = Double<N>;
  using V = Doubles3<N>;
  const V e1 = t.b - t.a, e2 = t.c - t.a, from_a = o - t.a;
  const V across = cross(d, e2), up = cross(from_a, e1);
  const D determinant = dot(e1, across), zero{};
  const D size1 = magnitudes_sum(e1), size2 = magnitudes_sum(e2), size_d = magnitudes_sum(d);
  const D far_terms = magnitudes_sum(from_a) * larger_of(size1, size2) * size_d;
  const auto is_wide = magnitude(determinant) > 0x1p-24 * (size1 * size2 * size_d);
  const auto is_near = magnitude(determinant) > 0x1p-38 * far_terms;
  const auto exists = is_wide & is_near;
  // The hit is inside the triangle, but rounding can give slightly negative weights.
  const D inverse = 1 / determinant;
  const D v = larger_of(D(dot(from_a, across) * inverse), zero);
  const D w = larger_of(D(dot(d, up) * inverse), zero);
  const D u = larger_of(D(1 - v - w), zero);
  const V weights{u, v, w};
  return Maybe3<N, decltype(exists)>{weights * (1 / (u + v + w)), exists};
}

/// The sum of the values at the corners, weighted by barycentric coordinates w.
template <class Weights, class Value>
inline Value weighted(const Weights& w, const Value& a, const Value& b, const Value& c) {
  return w.x * a + w.y * b + w.z * c;
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
