#pragma once
/// Intersection points of rays with triangles, and interpolated attributes.

#include "render/kernels/kernel.hpp"
#include "render/kernels/vector3.hpp"

namespace microtrace {
namespace {

/// Float64 vectors with N lanes, half as many as float vectors.
template <int N>
inline Vector3<Double<N>> widened3(const float (&v)[3][16], int i) {
  return {widened<N>(v[0] + i), widened<N>(v[1] + i), widened<N>(v[2] + i)};
}
template <int N>
inline void narrowed3(const Vector3<Double<N>>& v, float (&to)[3][16], int i) {
  narrowed<N>(v.x, to[0] + i);
  narrowed<N>(v.y, to[1] + i);
  narrowed<N>(v.z, to[2] + i);
}

/// The points of N paths starting at i. `area` receives the length of the edges' cross product.
template <int N>
inline void find_place(HitLanes& lanes, int i, LaneFloats& area) {
  using D = Double<N>;
  const D zero{};
  const auto o = widened3<N>(lanes.o, i), d = widened3<N>(lanes.d, i);
  const auto a = widened3<N>(lanes.corners[0], i);
  const auto e1 = widened3<N>(lanes.corners[1], i) - a;
  const auto e2 = widened3<N>(lanes.corners[2], i) - a;
  const auto n = cross(e1, e2);
  const D square = dot(n, n), slope = dot(n, d);
  const D t = dot(a - o, n) / slope;
  const D hit_t = widened<N>(lanes.t + i);
  const D one = zero + 1;
  narrowed<N>(((square > 0) & (magnitude(t - hit_t) <= 0x1p-20 * hit_t)) ? one : zero,
              lanes.is_sure + i);
  const auto p = o + t * d, from_a = p - a;
  const D inverse = 1 / square;
  const D v = larger_of(dot(cross(from_a, e2), n) * inverse, zero);
  const D w = larger_of(dot(cross(e1, from_a), n) * inverse, zero);
  const D u = larger_of(1 - v - w, zero), sum = u + v + w;
  narrowed3<N>(p, lanes.p, i);
  narrowed3<N>(Vector3<D>{u, v, w} / sum, lanes.weights, i);
  narrowed<N>(slope > 0 ? one : zero, lanes.from_behind + i);
  narrowed<N>(t * square_root<N>(dot(d, d)), lanes.distance + i);
  const D length = square_root<N>(square);
  narrowed3<N>(n / length, lanes.n, i);
  narrowed<N>(length, area + i);
}

template <int N>
inline void interpolate(HitLanes& lanes, int i, const LaneFloats& areas) {
  using F = Float<N>;
  const auto weights = load3<N>(lanes.weights, i), n = load3<N>(lanes.n, i);
  const auto weighed = [&](const auto& a, const auto& b, const auto& c) {
    return weights.x * a + weights.y * b + weights.z * c;
  };
  auto ns = weighed(load3<N>(lanes.normals[0], i), load3<N>(lanes.normals[1], i),
                    load3<N>(lanes.normals[2], i));
  const F square = dot(ns, ns);
  ns = select3(square > 0, ns / square_root<N>(square), n);
  store3<N>(lanes.ns, i, select3(dot(ns, n) < 0, -ns, ns));
  const auto at = [&](int corner, int axis) { return load<N>(lanes.uv[corner][axis] + i); };
  for (int axis = 0; axis < 2; ++axis)
    store<N>(lanes.first_uv[axis] + i, weighed(at(0, axis), at(1, axis), at(2, axis)));
  const F e1x = at(1, 0) - at(0, 0), e1y = at(1, 1) - at(0, 1);
  const F e2x = at(2, 0) - at(0, 0), e2y = at(2, 1) - at(0, 1);
  const F uv_area = magnitude(e1x * e2y - e1y * e2x), area = load<N>(areas + i);
  store<N>(lanes.uv_scale + i, square_root<N>(uv_area / area));
}

/// Processes N floats at a time.
template <int N>
void find_points(HitLanes& lanes) {
  alignas(64) LaneFloats areas;
  for (int i = 0; i < kShadingLanes; i += N / 2) find_place<N / 2>(lanes, i, areas);
  for (int i = 0; i < kShadingLanes; i += N) interpolate<N>(lanes, i, areas);
}

}  // namespace
}  // namespace microtrace
