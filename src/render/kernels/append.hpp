#pragma once
/// Appends lanes of some arrays to others.

#include "render/kernels/kernel.hpp"
#include "simd/vectors.hpp"

namespace microtrace {

/// Copies the given lanes of `from`, in order, to consecutive elements from to[0] on.
template <int N>
void append_column(const float* from, Lanes lanes, const int* indices, int count, float* to) {
  if (lanes == kAllLanes<kShadingLanes>) {
    __builtin_memcpy(to, from, sizeof(LaneFloats));
    return;
  }
#if defined(__AVX512F__)
  if constexpr (N == 16) {
    const __m512 packed = _mm512_maskz_compress_ps(static_cast<__mmask16>(lanes), load<N>(from));
    _mm512_mask_storeu_ps(to, static_cast<__mmask16>((1U << count) - 1), packed);
    return;
  }
#endif
  for (int i = 0; i < count; ++i) to[i] = from[indices[i]];
}

template <int N>
void append(const ColumnCopy* columns, int column_count, const AppendedLanes& which) {
  int indices[kShadingLanes], count = 0;
  for (Lanes lanes = which.lanes; lanes != 0; lanes &= lanes - 1)
    indices[count++] = __builtin_ctz(lanes);
  for (int i = 0; i < column_count; ++i) {
    append_column<N>(columns[i].from + which.from, which.lanes, indices, count,
                     columns[i].to + which.to);
  }
}

}  // namespace microtrace
