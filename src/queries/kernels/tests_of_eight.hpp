#pragma once
/// The functions of QueryKernels, which process N lanes of float64 at a time.

#include "accel/filters/roundings.hpp"
#include "accel/kernels/block_corners.hpp"
#include "queries/kernels/kernel.hpp"
#include "simd/vectors.hpp"

namespace microtrace {
namespace {

/// Returns the lanes in which a <= b; none for NaN.
template <int N>
inline unsigned lanes_at_most(const Double<N>& a, const Double<N>& b) {
#if defined(__AVX512VL__)
  if constexpr (N == 8) return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ);
#elif defined(__AVX2__)
  if constexpr (N == 4)
    return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(a, b, _CMP_LE_OQ)));
#endif
#if defined(__x86_64__)
  if constexpr (N == 2) return static_cast<unsigned>(_mm_movemask_pd(_mm_cmple_pd(a, b)));
#endif
  unsigned lanes = 0;
  for (int i = 0; i < N; ++i) lanes |= static_cast<unsigned>(a[i] <= b[i]) << i;
  return lanes;
}

template <int N>
inline Double<N> all_doubles(double x) {
  return x - Double<N>{};
}

/// A ray meets a box if the greatest of the entry distances is at most the least of the exit
/// distances. A distance (plane - o) / d has three roundings, and no result under- or overflows.
/// The entry distance is not negative, so enlarging the exit distance by 16 times the unit roundoff
/// covers the roundings of both.
template <int N>
unsigned entered(const WideNode& node, const LineInterval& ray) {
  const float *const lo = node.lo_x, *const hi = node.hi_x;  // arrays for y and z follow
  unsigned lanes = 0;
  for (int i = 0; i < kWidth; i += N) {
    Double<N> enter = all_doubles<N>(ray.t_min), leave = all_doubles<N>(ray.t_max);
    unsigned within = (1U << N) - 1;
    for (int axis = 0; axis < 3; ++axis) {
      const Double<N> from_lo = widened<N>(&lo[kWidth * axis + i]) - ray.o[axis];
      const Double<N> from_hi = widened<N>(&hi[kWidth * axis + i]) - ray.o[axis];
      const double d = ray.d[axis];
      if (d == 0) {
        within &= lanes_at_most<N>(from_lo, Double<N>{}) & lanes_at_most<N>(Double<N>{}, from_hi);
        continue;
      }
      const double inverse = 1 / d;
      enter = greater((d < 0 ? from_hi : from_lo) * inverse, enter);
      leave = lesser((d < 0 ? from_lo : from_hi) * inverse, leave);
    }
    within &= lanes_at_most<N>(enter, leave * (1 + 16 * kRoundoff));
    lanes |= within << i;
  }
  return lanes;
}

/// Let A, B, C be the vectors from the ray's origin to the vertices. The ray misses if two of d.(B
/// x C), d.(C x A), d.(A x B) have opposite signs. Each of these has six terms of at most |d_k|
/// m^2, where m is the largest |component| of A, B, C. A term has seven roundings: two of its
/// factors, two of products, one of the difference and two of sums. The bound allows eight, which
/// covers its own roundings.
template <int N>
unsigned passed(const TriangleBlock& block, const LineInterval& ray) {
  using V = Double<N>;
  const double d_sum = magnitude(ray.d[0]) + magnitude(ray.d[1]) + magnitude(ray.d[2]);
  unsigned lanes = 0;
  for (int i = 0; i < kWidth; i += N) {
    const BlockCorners<N> corners(block, i);
    V p[3], q[3], r[3], size{};
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = to_double<N>(corners.of[0][axis]) - ray.o[axis];
      q[axis] = to_double<N>(corners.of[1][axis]) - ray.o[axis];
      r[axis] = to_double<N>(corners.of[2][axis]) - ray.o[axis];
      size = greater(magnitude(p[axis]), size);
      size = greater(magnitude(q[axis]), size);
      size = greater(magnitude(r[axis]), size);
    }
    const auto volume = [&ray](const V(&x)[3], const V(&y)[3]) {
      return ray.d[0] * (x[1] * y[2] - x[2] * y[1]) + ray.d[1] * (x[2] * y[0] - x[0] * y[2]) +
             ray.d[2] * (x[0] * y[1] - x[1] * y[0]);
    };
    const V u = volume(q, r), v = volume(r, p), w = volume(p, q);
    const V error = 2 * 8 * kRoundoff * d_sum * (size * size);
    const V greatest = greater(greater(u, v), w), least = lesser(lesser(u, v), w);
    const unsigned is_used = lanes_at_most<N>(p[0], p[0]);  // unused lanes have NaN
    lanes |= (is_used & (lanes_at_most<N>(greatest, error) | lanes_at_most<N>(-error, least))) << i;
  }
  return lanes;
}

template <int N>
void box_distances(const WideNode& node, const double* p, double* squared) {
  const float *const lo = node.lo_x, *const hi = node.hi_x;
  for (int i = 0; i < kWidth; i += N) {
    Double<N> sum{};
    for (int axis = 0; axis < 3; ++axis) {
      const Double<N> below = widened<N>(&lo[kWidth * axis + i]) - p[axis];
      const Double<N> above = p[axis] - widened<N>(&hi[kWidth * axis + i]);
      const Double<N> gap = greater(greater(below, above), Double<N>{});
      sum += gap * gap;
    }
    __builtin_memcpy(squared + i, &sum, sizeof sum);
  }
}

/// Computes the larger of two lower bounds. The first is the distance of the bounding box, which is
/// a good bound near the triangle. Let A, B, C be the vectors from p to the vertices and G = A + B
/// + C. The second bound is the least of A.G / |G|, B.G / |G|, C.G / |G|, which is a good bound far
/// away. A.G has three terms of at most 3 m^2 with six roundings, where m is the largest
/// |component| of A, B, C.
template <int N>
void triangle_distances(const TriangleBlock& block, const double* p, double* squared) {
  using V = Double<N>;
  for (int i = 0; i < kWidth; i += N) {
    const BlockCorners<N> corners(block, i);
    V sum{}, size{}, from_a{}, from_b{}, from_c{}, squared_g{};
    for (int axis = 0; axis < 3; ++axis) {
      const V x = to_double<N>(corners.of[0][axis]) - p[axis];
      const V y = to_double<N>(corners.of[1][axis]) - p[axis];
      const V z = to_double<N>(corners.of[2][axis]) - p[axis];
      const V least = lesser(x, lesser(y, z)), greatest = greater(x, greater(y, z));
      const V gap = greater(greater(least, -greatest), V{});
      sum += gap * gap;
      size = greater(size, greater(-least, greatest));
      const V g = x + y + z;
      from_a += x * g;
      from_b += y * g;
      from_c += z * g;
      squared_g += g * g;
    }
    const V from = lesser(from_a, lesser(from_b, from_c)) - 3 * 3 * 8 * kRoundoff * size * size;
    // If G is 0, `from` is at most 0.
    const V bound = from > V{} ? from * from / squared_g : V{};
    const V result = greater(bound, sum);
    __builtin_memcpy(squared + i, &result, sizeof result);
  }
}

}  // namespace
}  // namespace microtrace
