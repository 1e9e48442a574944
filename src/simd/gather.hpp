#pragma once
/// Table lookups for N lanes.

#include "simd/vectors.hpp"

#include <cstdint>

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// Returns table[index] for each lane.
template <int N>
inline Float<N> gathered(const float* table, const Int<N>& index) {
#if defined(__AVX512F__)
  if constexpr (N == 16)
    return _mm512_mask_i32gather_ps(_mm512_setzero_ps(), 0xffff, (__m512i)index, table, 4);
#endif
#if defined(__AVX2__)
  if constexpr (N == 8) return _mm256_i32gather_ps(table, (__m256i)index, 4);
#endif
  Float<N> result{};
  for (int i = 0; i < N; ++i) set_lane(result, i, table[lane(index, i)]);
  return result;
}
template <int N>
inline Float<N> gathered(const std::int16_t* table, const Int<N>& index) {
  Float<N> result{};
  for (int i = 0; i < N; ++i) set_lane(result, i, static_cast<float>(table[lane(index, i)]));
  return result;
}
/// Returns lane i of columns[index[i]] for each lane i.
template <int N>
inline Float<N> picked(const Float<N>* columns, const Int<N>& index) {
  Int<N> offset = index * N;
  for (int i = 0; i < N; ++i) set_lane(offset, i, lane(offset, i) + i);
  return gathered<N>(reinterpret_cast<const float*>(columns), offset);
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
