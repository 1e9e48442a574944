#pragma once
/// Computes the intersection points of rays and triangles, and interpolated attributes.

#include "render/lanes/shading_kernels.hpp"
#include "simd/vector3.hpp"

namespace microtrace {

/// The points where N rays, which start at lane i, meet the planes of their triangles in float64.
template <int N>
struct PlanePoints {
  using D = Double<N>;
  using V = Doubles3<N>;
  V d, a, e1, e2, n, p;
  D square, slope, t;

  template <int width>
  PlanePoints(const HitArrays<width>& hits, int i)
      : PlanePoints({widened3<N>(hits.o, i), widened3<N>(hits.d, i)},
                    {widened3<N>(hits.corners[0], i), widened3<N>(hits.corners[1], i),
                     widened3<N>(hits.corners[2], i)}) {}

  struct Line {
    V o, d;
  };
  PlanePoints(const Line& ray, const V (&corners)[3])
      : d(ray.d),
        a(corners[0]),
        e1(corners[1] - a),
        e2(corners[2] - a),
        n(cross(e1, e2)),
        square(dot(n, n)),
        slope(dot(n, d)) {
    t = dot(a - ray.o, n) / slope;
    p = ray.o + t * d;
  }

  /// Each term of `slope` has at most six roundings and is at most the product of the three sums.
  /// If the triangle is not nearly edge-on, the relative error of `slope` is therefore below 2^-26.
  /// The test fails for triangles without area.
  [[nodiscard]] auto are_sure() const {
    const D terms = magnitudes_sum(e1) * magnitudes_sum(e2) * magnitudes_sum(d);
    return (square > 0) & (magnitude(D(slope)) > 0x1p-24 * terms);
  }

  /// Returns the barycentric weights of p. `inverse` is 1 / square.
  [[nodiscard]] V weights(const D& inverse) const {
    const D zero{};
    const V from_a = p - a;
    const D v = larger_of(D(dot(cross(from_a, e2), n) * inverse), zero);
    const D w = larger_of(D(dot(cross(e1, from_a), n) * inverse), zero);
    const D u = larger_of(D(1 - v - w), zero), sum = u + v + w;
    return V{u, v, w} * (1 / sum);
  }

  /// Calls put(values, array) for the results that all hits have.
  template <int width, class Put>
  void put_common(const Put& put, HitArrays<width>& hits) const {
    const D zero{}, one = zero + 1;
    put(are_sure() ? one : zero, hits.is_sure);
    put(p.x, hits.p[0]);
    put(p.y, hits.p[1]);
    put(p.z, hits.p[2]);
    put(slope > 0 ? one : zero, hits.from_behind);
    put(t * square_root<N>(dot(d, d)), hits.distance);
  }
};

/// Computes the points of the N paths that start at lane i.
template <int N, int width>
void intersect_planes(HitArrays<width>& hits, int i) {
  using D = Double<N>;
  const PlanePoints<N> at(hits, i);
  at.put_common([&](const D& x, float* to) { narrowed<N>(x, to + i); }, hits);
  const D inverse = 1 / at.square;
  narrowed3<N>(at.weights(inverse), hits.weights, i);
  const D length = square_root<N>(at.square);
  narrowed3<N>(at.n * (length * inverse), hits.n, i);
  narrowed<N>(length, hits.area + i);
}

/// Returns sqrt(area in texture coordinates / area in world space) of triangles with these texture
/// coordinates of their corners. `area` is twice the area in world space.
template <int N>
Float<N> uv_scale(const Floats2<N> (&uv)[3], const Float<N>& area) {
  const Floats2<N> e1{uv[1].x - uv[0].x, uv[1].y - uv[0].y};
  const Floats2<N> e2{uv[2].x - uv[0].x, uv[2].y - uv[0].y};
  return square_root<N>(magnitude(Float<N>(e1.x * e2.y - e1.y * e2.x)) / area);
}

/// Interpolates the attributes of points by the barycentric weights that intersect_planes() has
/// computed.
template <int N, int width>
void interpolate(HitArrays<width>& hits, int i) {
  using F = Float<N>;
  using V = Floats3<N>;
  const V weights = load3<N>(hits.weights, i), n = load3<N>(hits.n, i);
  const auto weighed = [&](const auto& a, const auto& b, const auto& c) {
    return weights.x * a + weights.y * b + weights.z * c;
  };
  V ns = weighed(load3<N>(hits.normals[0], i), load3<N>(hits.normals[1], i),
                 load3<N>(hits.normals[2], i));
  const F square = dot(ns, ns);
  ns = select3(square > 0, unit<N>(ns), n);
  // In some files, the winding contradicts the normals. The winding defines the front side.
  store3<N>(hits.ns, i, select3(dot(ns, n) < 0, V(-ns), ns));
  Floats2<N> uv[3];
  for (int corner = 0; corner < 3; ++corner)
    uv[corner] = {load<N>(hits.uv[corner][0] + i), load<N>(hits.uv[corner][1] + i)};
  store<N>(hits.first_uv[0] + i, weighed(uv[0].x, uv[1].x, uv[2].x));
  store<N>(hits.first_uv[1] + i, weighed(uv[0].y, uv[1].y, uv[2].y));
  store<N>(hits.first_uv_scale + i, uv_scale<N>(uv, load<N>(hits.area + i)));
}

/// Computes all points and attributes, with vectors of N floats.
template <int N, int width>
void find_points(HitArrays<width>& hits) {
  for (int i = 0; i < width; i += kDoubleLanes<N>) intersect_planes<kDoubleLanes<N>>(hits, i);
  for (int i = 0; i < width; i += N) interpolate<N>(hits, i);
}

}  // namespace microtrace
