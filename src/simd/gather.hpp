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
/// gathered() for a table of 16 entries, aligned to 64 bytes. Faster, because it needs no memory
/// access per lane.
template <int N>
inline Float<N> gathered_of_16(const float* table, const Int<N>& index) {
#if defined(__AVX512F__)
  if constexpr (N == 16)
    return _mm512_maskz_permutexvar_ps(0xffff, (__m512i)index, _mm512_load_ps(table));
#elif defined(__AVX2__)
  if constexpr (N == 8) {
    const __m256 low = _mm256_permutevar8x32_ps(_mm256_load_ps(table), (__m256i)index);
    const __m256 high = _mm256_permutevar8x32_ps(_mm256_load_ps(table + 8), (__m256i)index);
    return _mm256_blendv_ps(low, high, _mm256_castsi256_ps(_mm256_slli_epi32((__m256i)index, 28)));
  }
#endif
  return gathered<N>(table, index);
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
