#pragma once
/// Decides most edge tests that float32 can't decide. Evaluates the forms of volume_test.hpp in
/// float64 for one triangle and one ray, with the same error bound but the unit roundoff of
/// float64.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

enum class Within { no, unsure, yes };

thread_local std::uint64_t edge_test_count = 0;

inline std::uint64_t edge_tests() {
  return edge_test_count;
}

/// A triangle relative to a ray's origin in float64: a is the vector from the origin to the first
/// vertex, and e1 and e2 are the edges from the first vertex.
struct NearTriangle {
  double a[3], e1[3], e2[3];

  NearTriangle(const TriangleBlock& block, int k, const float* o) {
    const auto slot = static_cast<std::size_t>(k);
    for (int axis = 0; axis < 3; ++axis) {
      const double first = coordinate(block, 0, slot, axis);
      a[axis] = first - o[axis];
      e1[axis] = coordinate(block, 1, slot, axis) - first;
      e2[axis] = coordinate(block, 2, slot, axis) - first;
    }
  }
};

inline double sum_of_magnitudes(const double (&x)[3]) {
  return __builtin_fabs(x[0]) + __builtin_fabs(x[1]) + __builtin_fabs(x[2]);
}
inline double largest_magnitude(const double (&x)[3]) {
  return greater(greater(__builtin_fabs(x[0]), __builtin_fabs(x[1])), __builtin_fabs(x[2]));
}

/// The error of a triple product relative to the sum of its terms' magnitudes. A term has at most 8
/// roundings; the .01 covers second-order terms.
constexpr double kTripleProductError = 8.01 * 0x1p-53;

/// True if the ray's line certainly meets the plane of triangle k of a block at t < 0. Most
/// triangles that float32 can't decide are those that the ray has just left.
inline bool is_left_behind(const TriangleBlock& block, int k, const float* o, const float* d) {
  const NearTriangle t(block, k, o);
  // The bounds sum the magnitudes of actual terms, of which an axis-aligned triangle has only one
  // per form. This matters because a ray that leaves a floor at 0 may start only 2^-149 above it.
  double height = 0, size = 0, height_sum = 0, size_sum = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, l = (i + 2) % 3;
    const double left = t.e1[j] * t.e2[l], right = t.e1[l] * t.e2[j];
    const double n = left - right, sum = __builtin_fabs(left) + __builtin_fabs(right);
    height += n * t.a[i];
    size += n * d[i];
    height_sum += sum * __builtin_fabs(t.a[i]);
    size_sum += sum * __builtin_fabs(double{d[i]});
  }
  const double height_bound = height_sum * kTripleProductError + 0x1p-600;
  const double size_bound = size_sum * kTripleProductError + 0x1p-600;
  return size > 0 ? size > size_bound && height < -height_bound
                  : size < -size_bound && height > height_bound;
}

/// Decides whether a ray arrives at the front of triangle k of a block.
__attribute__((always_inline)) inline Within meets_front(const TriangleBlock& block, int k,
                                                         const float* d) {
  const float origin[3] = {0, 0, 0};
  const NearTriangle t(block, k, origin);
  double slope = 0, sum = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, l = (i + 2) % 3;
    const double left = t.e1[j] * t.e2[l], right = t.e1[l] * t.e2[j];
    slope += (left - right) * d[i];
    sum += (__builtin_fabs(left) + __builtin_fabs(right)) * __builtin_fabs(double{d[i]});
  }
  const double bound = sum * kTripleProductError + 0x1p-600;
  if (slope < -bound) return Within::yes;
  return slope > bound ? Within::no : Within::unsure;
}

/// The signed volumes of volume_test.hpp in float64.
struct NearVolumes {
  double u = 0, v = 0, size = 0;

  NearVolumes(const NearTriangle& t, const float* d) {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, l = (i + 2) % 3;
      u += (t.e2[j] * t.a[l] - t.e2[l] * t.a[j]) * d[i];
      v += (t.a[j] * t.e1[l] - t.a[l] * t.e1[j]) * d[i];
      size += (t.e1[j] * t.e2[l] - t.e1[l] * t.e2[j]) * d[i];
    }
  }
};

inline double sum_of_magnitudes(const float* x) {
  const double widened[3] = {x[0], x[1], x[2]};
  return sum_of_magnitudes(widened);
}

/// Decides whether the line of a ray passes through triangle k of a block, including its edges.
inline Within within_edges(const TriangleBlock& block, int k, const float* o, const float* d) {
  ++edge_test_count;
  const NearTriangle t(block, k, o);
  auto [u, v, size] = NearVolumes(t, d);
  if (size < 0) {
    u = -u;
    v = -v;
    size = -size;
  }
  const double largest1 = largest_magnitude(t.e1), largest2 = largest_magnitude(t.e2);
  const double bound =
      (sum_of_magnitudes(t.a) * greater(largest1, largest2) + largest1 * largest2) *
          (15.01 * 0x1p-53 * sum_of_magnitudes(d)) +
      0x1p-600;
  const double within = lesser(lesser(u, v), size - (u + v));
  if (within > bound) return Within::yes;
  return within < -bound ? Within::no : Within::unsure;
}

/// The weights at the hit of triangle k of a block. Let T be the sum of |o_i|, of the components of
/// a, and of those of the edges, all without signs, E the sum of those of the edges, and D that of
/// |d_i|. The errors of u and v are below 2^-48 T E D / |size|. Those of PlanePoints are greatest
/// where t is uncertain: the error of t is below 2^-47 T E^2 / |size| and changes the weights by at
/// most E D^2 / |size| per unit of t. PlanePoints uses the scene's first vertex, for which T and E
/// may be twice as large. As |size| is at most E^2 D, all errors together, rounded to float32, are
/// below kError if T E^3 D^2 is below 2^24 size^2.
///
/// Not inlined, because it would take registers from the tests of scenes without masks.
__attribute__((noinline)) inline HitWeights weights_at_hit(const TriangleBlock& block, int k,
                                                           const float* o, const float* d) {
  const NearTriangle t(block, k, o);
  auto [u, v, size] = NearVolumes(t, d);
  const double inverse = 1 / size, edges = sum_of_magnitudes(t.e1) + sum_of_magnitudes(t.e2);
  const double scale = edges * sum_of_magnitudes(d);
  u *= inverse;
  v *= inverse;
  // Those of the block's c, b, a, c. The scene's vertices are the block's, rotated.
  const double weights[4] = {v, u, 1 - u - v, v};
  const unsigned first = scene_number(block, static_cast<std::size_t>(k));
  return {
      .second = static_cast<float>(weights[first + 1]),
      .third = static_cast<float>(weights[first]),
      .are_sure = (sum_of_magnitudes(o) + sum_of_magnitudes(t.a) + edges) * edges * scale * scale <
                  0x1p24 * size * size};
}

}  // namespace
}  // namespace microtrace
