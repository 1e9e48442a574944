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

/// Barycentric coordinates of the point where the ray meets the triangle's plane. A vertex's weight
/// is proportional to the volume spanned by the ray and the opposite edge. None for triangles that
/// have no area or are seen exactly edge-on.
template <int N>
inline auto barycentrics_of(const TriangleCorners<N>& t, const Doubles3<N>& o,
                            const Doubles3<N>& d) {
  using V = Doubles3<N>;
  const V a = t.a - o, b = t.b - o, c = t.c - o;
  const V volumes{dot(d, cross(c, b)), dot(d, cross(a, c)), dot(d, cross(b, a))};
  const Double<N> sum = volumes.x + volumes.y + volumes.z, zero{};
  // The hit is inside the triangle, but rounding can give slightly negative weights.
  const V weights = greatest_components(V(volumes / sum), V{zero, zero, zero});
  const Double<N> total = weights.x + weights.y + weights.z;
  const auto exists = (total > 0) & (total <= kGreatestDouble);
  return Maybe3<N, decltype(exists)>{weights / total, exists};
}

/// The sum of the values at the corners, weighted by barycentric coordinates w.
template <class Weights, class Value>
inline Value weighted(const Weights& w, const Value& a, const Value& b, const Value& c) {
  return w.x * a + w.y * b + w.z * c;
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
