#pragma once
/// What float32 can't tell about a triangle's edges, float64 mostly can: the forms of
/// block_test.hpp again, for one triangle and one ray, with the same bound by the smaller unit.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

enum class Within { no, unsure, yes };

thread_local std::uint64_t edge_test_count = 0;

inline std::uint64_t edge_tests() {
  return edge_test_count;
}

/// Whether the line of a ray goes through triangle k of a block, all edges included.
inline Within within_edges(const TriangleBlock& block, int k, const float* o, const float* d) {
  ++edge_test_count;
  const double a[3] = {double{block.a_x[k]} - o[0], double{block.a_y[k]} - o[1],
                       double{block.a_z[k]} - o[2]};
  const double e1[3] = {double{block.b_x[k]} - block.a_x[k], double{block.b_y[k]} - block.a_y[k],
                        double{block.b_z[k]} - block.a_z[k]};
  const double e2[3] = {double{block.c_x[k]} - block.a_x[k], double{block.c_y[k]} - block.a_y[k],
                        double{block.c_z[k]} - block.a_z[k]};
  double u = 0, v = 0, size = 0, a_sum = 0, d_sum = 0, largest1 = 0, largest2 = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, l = (i + 2) % 3;
    u += (e2[j] * a[l] - e2[l] * a[j]) * d[i];
    v += (a[j] * e1[l] - a[l] * e1[j]) * d[i];
    size += (e1[j] * e2[l] - e1[l] * e2[j]) * d[i];
    a_sum += __builtin_fabs(a[i]);
    d_sum += __builtin_fabs(double{d[i]});
    largest1 = greater(largest1, __builtin_fabs(e1[i]));
    largest2 = greater(largest2, __builtin_fabs(e2[i]));
  }
  if (size < 0) {
    u = -u;
    v = -v;
    size = -size;
  }
  // Two roundings more than block_test.hpp's forms cover those of the bound itself.
  const double bound =
      (a_sum * greater(largest1, largest2) + largest1 * largest2) * (20 * 0x1p-53 * d_sum) +
      0x1p-600;
  const double within = lesser(lesser(u, v), size - (u + v));
  if (within > bound) return Within::yes;
  return within < -bound ? Within::no : Within::unsure;
}

}  // namespace
}  // namespace microtrace
