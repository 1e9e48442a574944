#pragma once
/// Functions on the results of comparisons of SIMD vectors.

#include "simd/vectors.hpp"

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// Returns the lanes in which a comparison of float64 or 64-bit integer vectors is true.
template <int N, class Mask>
inline Lanes true_double_lanes(const Mask& mask) {
#if defined(__AVX512DQ__)
  if constexpr (N == 8) return _mm512_movepi64_mask(reinterpreted<__m512i>(mask));
#endif
#if defined(__AVX2__)
  if constexpr (N == 4) return static_cast<Lanes>(_mm256_movemask_pd(reinterpreted<__m256d>(mask)));
#endif
#if defined(__x86_64__)
  if constexpr (N == 2) return static_cast<Lanes>(_mm_movemask_pd(reinterpreted<__m128d>(mask)));
#endif
  Lanes lanes = 0;
  for (int i = 0; i < N; ++i) lanes |= static_cast<Lanes>(lane(mask, i) != 0) << i;
  return lanes;
}

/// Returns the lanes in which a comparison of float32 or integer vectors is true.
template <int N, class Mask>
inline Lanes true_lanes(const Mask& mask) {
#if defined(__AVX512VL__)
  if constexpr (N == 16) return _mm512_movepi32_mask(reinterpreted<__m512i>(mask));
  if constexpr (N == 8) return _mm256_movepi32_mask(reinterpreted<__m256i>(mask));
#elif defined(__AVX2__)
  if constexpr (N == 8) return static_cast<Lanes>(_mm256_movemask_ps(reinterpreted<__m256>(mask)));
#endif
#if defined(__x86_64__)
  if constexpr (N == 4) return static_cast<Lanes>(_mm_movemask_ps(reinterpreted<__m128>(mask)));
#endif
  Lanes lanes = 0;
  for (int i = 0; i < N; ++i) lanes |= static_cast<Lanes>(lane(mask, i) != 0) << i;
  return lanes;
}

/// Returns true if the result of a comparison is true in any lane.
template <class Mask>
inline bool any(const Mask& mask) {
  if constexpr (sizeof mask <= sizeof(int)) {
    return mask != 0;
  } else if constexpr (sizeof mask[0] == sizeof(double)) {
    return true_double_lanes<sizeof mask / sizeof(double)>(mask) != 0;
  } else {
    return true_lanes<sizeof mask / sizeof(mask[0])>(mask) != 0;
  }
}

template <class Mask>
inline auto negated(const Mask& mask) {
  return mask == 0;
}

/// Returns true if the result of a comparison is true in all lanes.
template <class Mask>
inline bool are_all(const Mask& mask) {
  return !any(negated(mask));
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
