#pragma once
/// Transposes small matrices.

#include "simd/vectors.hpp"

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// Transposes a 4 x 4 matrix.
inline void transpose(Float<4> (&m)[4]) {
  const Float<4> low01 = __builtin_shufflevector(m[0], m[1], 0, 4, 1, 5),
                 high01 = __builtin_shufflevector(m[0], m[1], 2, 6, 3, 7),
                 low23 = __builtin_shufflevector(m[2], m[3], 0, 4, 1, 5),
                 high23 = __builtin_shufflevector(m[2], m[3], 2, 6, 3, 7);
  m[0] = __builtin_shufflevector(low01, low23, 0, 1, 4, 5);
  m[1] = __builtin_shufflevector(low01, low23, 2, 3, 6, 7);
  m[2] = __builtin_shufflevector(high01, high23, 0, 1, 4, 5);
  m[3] = __builtin_shufflevector(high01, high23, 2, 3, 6, 7);
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
