#pragma once
/// Computes the rounded parameters t of known hits, several at a time. t = (A.n) / (d.n) is
/// evaluated in float64 with the error bound of TrianglePlaneFilter, which
/// src/accel/filters/triangle_filter.hpp derives.

#include "accel/filters/roundings.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"
#include "simd/vector3.hpp"

namespace microtrace {
namespace {

/// Planes relative to the origin of rays: a normal n, and the height A.n, where A is the vector
/// from the origin to a point of the plane.
template <class D>
struct PlaneFromOrigin {
  Vector3<D> n;
  D height, height_error;
};

/// The planes of triangles (a, b, c), with n = e1 x e2 and A = a - o.
template <class D>
struct TrianglePlane : PlaneFromOrigin<D> {
  Vector3<D> sum;  ///< the permanent of each component of n (see filter.hpp)

  TrianglePlane(const Vector3<D>& o, const Vector3<D>& a, const Vector3<D>& b,
                const Vector3<D>& c) {
    const Vector3<D> from = a - o, e1 = b - a, e2 = c - a;
    const Vector3<D> left{e1.y * e2.z, e1.z * e2.x, e1.x * e2.y};
    const Vector3<D> right{e1.z * e2.y, e1.x * e2.z, e1.y * e2.x};
    sum = magnitudes(left) + magnitudes(right);
    this->n = left - right;
    this->height = dot(this->n, from);
    this->height_error = kHeightRoundings * kRounding * dot(sum, magnitudes(from)) + kUnderflow;
  }
};

/// Writes N parameters t and returns the lanes whose t is certainly rounded correctly. size_error
/// bounds the error of d.n.
template <int N>
inline Lanes round_t(const PlaneFromOrigin<Double<N>>& plane, const Vector3<Double<N>>& d,
                     const Double<N>& size_error, float* t) {
  using V = Double<N>;
  const V size = dot(plane.n, d);
  // Like quotient_result, but with only one division. t and the ends of its interval have three
  // more roundings than the quotient, so half of the 8 would suffice. If size exceeds 64 times its
  // error, 1 / (size - error) is at most 64/63 / size, which the factor 1.04 covers; requiring 32
  // times its error would suffice. The result for smaller sizes is too imprecise to round t.
  const V inverse = 1.0 / size, middle = plane.height * inverse, distance = magnitude(middle);
  V error = (plane.height_error + distance * size_error) * magnitude(inverse) * 1.04 +
            distance * (8 * kRounding) + kUnderflow;
  error = magnitude(size) > 64 * size_error ? error : V{} + __builtin_inf();
  float below[N], above[N];
  narrowed<N>(middle - error, below);
  narrowed<N>(middle + error, above);
  store<N>(t, load<N>(below) + 0.0F);  // -0 becomes 0
  return less_equal<N>(load<N>(above), load<N>(below));
}

template <int N>
std::uint64_t round_t(HitBatch& hits) {
  using D = Double<N>;
  std::uint64_t certain = 0;
  for (int i = 0; i < kHitBatch; i += N) {
    const Vector3<D> o{widened<N>(hits.o[0] + i), widened<N>(hits.o[1] + i),
                       widened<N>(hits.o[2] + i)};
    const Vector3<D> d{widened<N>(hits.d[0] + i), widened<N>(hits.d[1] + i),
                       widened<N>(hits.d[2] + i)};
    const TrianglePlane<D> plane(o, widened3<N>(hits.a, i), widened3<N>(hits.b, i),
                                 widened3<N>(hits.c, i));
    const D size_error = kSlopeRoundings * kRounding * dot(plane.sum, magnitudes(d)) + kUnderflow;
    certain |= std::uint64_t{round_t<N>(plane, d, size_error, hits.t + i)} << i;
  }
  return certain;
}

}  // namespace
}  // namespace microtrace
