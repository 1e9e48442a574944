#pragma once
/// The parameters of hits that are known to be, rounded once: t = (A.n) / (d.n) by float64 with
/// TrianglePlaneFilter's error bound (src/accel/filters/triangle_filter.hpp derives it), for
/// several hits at once.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

template <int N>
struct Double3 {
  Double<N> x, y, z;
};

template <int N>
inline Double3<N> difference(const float (*p)[kHitBatch], const float* x, const float* y,
                             const float* z, int i) {
  return {widened<N>(p[0] + i) - widened<N>(x + i), widened<N>(p[1] + i) - widened<N>(y + i),
          widened<N>(p[2] + i) - widened<N>(z + i)};
}

template <int N>
std::uint64_t round_t(HitBatch& hits) {
  using D = Double<N>;
  constexpr double unit = 0x1p-53;
  std::uint64_t certain = 0;
  for (int i = 0; i < kHitBatch; i += N) {
    const Double3<N> a = difference<N>(hits.a, hits.o[0], hits.o[1], hits.o[2], i);
    const Double3<N> e1 = difference<N>(hits.b, hits.a[0], hits.a[1], hits.a[2], i),
                     e2 = difference<N>(hits.c, hits.a[0], hits.a[1], hits.a[2], i);
    const D left_x = e1.y * e2.z, left_y = e1.z * e2.x, left_z = e1.x * e2.y;
    const D right_x = e1.z * e2.y, right_y = e1.x * e2.z, right_z = e1.y * e2.x;
    const D sum_x = magnitude(left_x) + magnitude(right_x),
            sum_y = magnitude(left_y) + magnitude(right_y),
            sum_z = magnitude(left_z) + magnitude(right_z);
    const D nx = left_x - right_x, ny = left_y - right_y, nz = left_z - right_z;
    const D dx = widened<N>(hits.d[0] + i), dy = widened<N>(hits.d[1] + i),
            dz = widened<N>(hits.d[2] + i);
    const D height = nx * a.x + ny * a.y + nz * a.z, size = nx * dx + ny * dy + nz * dz;
    const D height_error =
        9 * unit * (sum_x * magnitude(a.x) + sum_y * magnitude(a.y) + sum_z * magnitude(a.z)) +
        0x1p-600;
    const D size_error =
        8 * unit * (sum_x * magnitude(dx) + sum_y * magnitude(dy) + sum_z * magnitude(dz)) +
        0x1p-600;
    // As quotient_verdict, with one division: t errs by three roundings more than the quotient, and
    // where size is above four times its error, 1 / (size - error) is at most 4/3 / size.
    const D inverse = 1.0 / size, t = height * inverse, distance = magnitude(t);
    const D error = (height_error + distance * size_error) * magnitude(inverse) * 1.34 +
                    distance * (8 * unit) + 0x1p-600;
    float above[N];
    narrowed<N>(t - error, hits.t + i);
    narrowed<N>(t + error, above);
    const D room = magnitude(size) - 4 * size_error;
    for (int lane = 0; lane < N; ++lane)
      certain |= std::uint64_t{room[lane] > 0 && hits.t[i + lane] == above[lane]} << (i + lane);
  }
  return certain;
}

}  // namespace
}  // namespace microtrace
