#pragma once
/// Appends lanes of some arrays to others.

#include "render/lanes/shading_kernels.hpp"
#include "simd/lane_count.hpp"
#include "simd/vectors.hpp"

namespace microtrace {

template <int N>
int append(const ColumnCopy* columns, int column_count, const AppendedLanes& which) {
  const auto append_all = [&](const auto& append_column) {
    for (int i = 0; i < column_count; ++i)
      append_column(columns[i].from + which.from, columns[i].to + which.to);
  };
  const int count = lane_count(which.lanes);
  if (which.lanes == kAllLanes<kShadingLanes>) {
    append_all(
        [](const float* from, float* to) { __builtin_memcpy(to, from, sizeof(LaneFloats)); });
    return count;
  }
#if defined(__AVX512F__)
  if constexpr (N == 16) {
    const auto lanes = static_cast<__mmask16>(which.lanes);
    if (which.fills_lanes) {
      // Stores of whole vectors are fastest where they don't cross cache lines.
      const auto added = static_cast<__mmask16>(((1U << count) - 1) << which.to);
      const __m512i numbers =
          _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
      const __m512i places =
          _mm512_maskz_expand_epi32(added, _mm512_maskz_compress_epi32(lanes, numbers));
      for (int i = 0; i < column_count; ++i) {
        float* const to = columns[i].to;
        _mm512_storeu_ps(to, _mm512_mask_permutexvar_ps(load<N>(to), added, places,
                                                        load<N>(columns[i].from + which.from)));
      }
      return count;
    }
    // What follows the lanes is overwritten later or not used.
    append_all([&](const float* from, float* to) {
      _mm512_storeu_ps(to, _mm512_maskz_compress_ps(lanes, load<N>(from)));
    });
    return count;
  }
#endif
  int indices[kShadingLanes];
  Lanes rest = which.lanes;
  for (int i = 0; i < count; ++i, rest &= rest - 1) indices[i] = __builtin_ctz(rest);
  append_all([&](const float* from, float* to) {
    for (int i = 0; i < count; ++i) to[i] = from[indices[i]];
  });
  return count;
}

}  // namespace microtrace
