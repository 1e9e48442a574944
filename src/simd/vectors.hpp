#pragma once
/// Functions on the SIMD vectors of vector_types.hpp.

#include "simd/vector_types.hpp"

#include <cstdint>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

template <int N>
inline Float<N> load(const float* p) {
  Float<N> v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}

template <int N>
inline Unsigned<N> load_bits(const std::uint32_t* p) {
  Unsigned<N> v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}

template <int N>
inline void store(float* p, const Float<N>& v) {
  __builtin_memcpy(p, &v, sizeof v);
}

template <int N>
inline Float<N> all(float x) {
  return x - Float<N>{};  // x - 0 is x, even for -0 and NaN
}

/// Returns a where a < b, otherwise b. If one of them is NaN, the result is b, as with the min
/// instruction of x86.
template <class V>
inline V lesser(const V& a, const V& b) {
  return a < b ? a : b;
}
template <class V>
inline V greater(const V& a, const V& b) {
  return a > b ? a : b;
}
/// Returns |a| by clearing the sign bit, so -0 becomes 0.
template <class V>
inline V magnitude(const V& a) {
  if constexpr (sizeof(lane(a, 0)) == 4)
    return reinterpreted<V>(reinterpreted<Int<sizeof(V) / 4>>(a) & 0x7fffffff);
  else
    return reinterpreted<V>(reinterpreted<Long<sizeof(V) / 8>>(a) & 0x7fffffffffffffff);
}

/// Returns a, negated in lanes in which b is negative or -0.
template <int N>
inline Float<N> with_sign_of(const Float<N>& a, const Float<N>& b) {
  return reinterpreted<Float<N>>(reinterpreted<Int<N>>(a) ^ (reinterpreted<Int<N>>(b) & INT32_MIN));
}

/// Returns a where the mask is true, otherwise b, without a branch also for one lane.
template <int N, class Mask>
inline Float<N> chosen(const Mask& mask, const Float<N>& a, const Float<N>& b) {
  if constexpr (N == 1) {
    const std::int32_t bits = -static_cast<std::int32_t>(mask);
    return reinterpreted<float>((reinterpreted<std::int32_t>(a) & bits) |
                                (reinterpreted<std::int32_t>(b) & ~bits));
  } else {
    return mask ? a : b;
  }
}

/// Rounds toward zero to integers. Each lane must be in the range of the integers.
template <int N>
inline Int<N> truncated(const Float<N>& a) {
  if constexpr (N == 1)
    return static_cast<Int<N>>(a);
  else
    return __builtin_convertvector(a, Int<N>);
}
template <int N>
inline Long<N> truncated(const Double<N>& a) {
  if constexpr (N == 1)
    return static_cast<Long<N>>(a);
  else
    return __builtin_convertvector(a, Long<N>);
}
template <int N>
inline Int<N> truncated_to_int(const Double<N>& a) {
  if constexpr (N == 1)
    return static_cast<Int<N>>(a);
  else
    return __builtin_convertvector(a, Int<N>);
}
template <int N>
inline Float<N> to_float(const Int<N>& a) {
  if constexpr (N == 1)
    return static_cast<float>(a);
  else
    return __builtin_convertvector(a, Float<N>);
}

/// Convert between float32 and float64; the conversion to float32 rounds.
template <int N>
inline Double<N> to_double(const Float<N>& a) {
  // GCC 12 converts the halves of a vector separately.
#if defined(__AVX512F__)
  if constexpr (N == 8) return _mm512_maskz_cvtps_pd(0xff, a);
#endif
#if defined(__AVX__)
  if constexpr (N == 4) return _mm256_cvtps_pd(a);
#endif
  if constexpr (N == 1)
    return a;
  else
    return __builtin_convertvector(a, Double<N>);
}
template <int N>
inline Double<N> to_double(const Long<N>& a) {
  if constexpr (N == 1)
    return static_cast<double>(a);
  else
    return __builtin_convertvector(a, Double<N>);
}
template <int N>
inline Float<N> to_single(const Double<N>& a) {
  if constexpr (N == 1)
    return static_cast<float>(a);
  else
    return __builtin_convertvector(a, Float<N>);
}

/// Loads N float32 numbers as float64.
template <int N>
inline Double<N> widened(const float* p) {
  return to_double<N>(load<N>(p));
}
/// Rounds to float32 and stores the result.
template <int N>
inline void narrowed(const Double<N>& v, float* p) {
  store<N>(p, to_single<N>(v));
}

/// Converts the result of a float64 comparison to a mask that selects float32 lanes.
template <int N, class Mask>
inline auto single_mask(const Mask& mask) {
  return to_single<N>(mask ? Double<N>{} + 1 : Double<N>{}) != 0;
}

/// Moves positive finite lanes by n units in the last place.
template <int N>
inline Float<N> moved_by_ulps(const Float<N>& a, int n) {
  using Bits = typename FloatVector<N>::bits_type;
  return (Float<N>)((Bits)a + n);
}

/// Returns the lanes in which a <= b; none for NaN.
template <int N>
inline Lanes less_equal(const Float<N>& a, const Float<N>& b) {
#if defined(__AVX512VL__)
  if constexpr (N == 16) return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ);
  if constexpr (N == 8) return _mm256_cmp_ps_mask(a, b, _CMP_LE_OQ);
#elif defined(__AVX2__)
  if constexpr (N == 8)
    return static_cast<Lanes>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)));
#endif
#if defined(__x86_64__)
  if constexpr (N == 4) return static_cast<Lanes>(_mm_movemask_ps(_mm_cmple_ps(a, b)));
#endif
  Lanes lanes = 0;
  for (int i = 0; i < N; ++i) lanes |= static_cast<Lanes>(lane(a, i) <= lane(b, i)) << i;
  return lanes;
}

/// Returns the lanes in which a < b; none for NaN.
template <int N>
inline Lanes less(const Float<N>& a, const Float<N>& b) {
#if defined(__AVX512VL__)
  if constexpr (N == 16) return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ);
  if constexpr (N == 8) return _mm256_cmp_ps_mask(a, b, _CMP_LT_OQ);
#elif defined(__AVX2__)
  if constexpr (N == 8)
    return static_cast<Lanes>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LT_OQ)));
#endif
#if defined(__x86_64__)
  if constexpr (N == 4) return static_cast<Lanes>(_mm_movemask_ps(_mm_cmplt_ps(a, b)));
#endif
  Lanes lanes = 0;
  for (int i = 0; i < N; ++i) lanes |= static_cast<Lanes>(lane(a, i) < lane(b, i)) << i;
  return lanes;
}

/// Returns integer lanes with all bits set in the given lanes and zero in the others.
template <int N>
inline auto mask_of(Lanes lanes) {
  using Bits = typename FloatVector<N>::bits_type;
  Bits bit{};
  for (int i = 0; i < N; ++i) set_lane(bit, i, 1 << i);
  return (bit & static_cast<std::int32_t>(lanes)) != 0;
}

/// Returns a in the given lanes and b in the others.
template <int N>
inline Float<N> select(Lanes lanes, const Float<N>& a, const Float<N>& b) {
#if defined(__AVX512VL__)
  if constexpr (N == 16) return _mm512_mask_blend_ps(static_cast<__mmask16>(lanes), b, a);
  if constexpr (N == 8) return _mm256_mask_blend_ps(static_cast<__mmask8>(lanes), b, a);
#endif
  return mask_of<N>(lanes) ? a : b;
}

/// Returns square roots, correctly rounded as IEEE 754 requires.
template <int N>
inline Float<N> square_root(const Float<N>& a) {
#if defined(__AVX512F__)
  if constexpr (N == 16) return _mm512_maskz_sqrt_ps(0xffff, a);
#endif
#if defined(__AVX2__)
  if constexpr (N == 8) return _mm256_sqrt_ps(a);
#endif
#if defined(__x86_64__)
  if constexpr (N == 4) return _mm_sqrt_ps(a);
#endif
  Float<N> result{};
  for (int i = 0; i < N; ++i) set_lane(result, i, __builtin_sqrtf(lane(a, i)));
  return result;
}
template <int N>
inline Double<N> square_root(const Double<N>& a) {
#if defined(__AVX512F__)
  if constexpr (N == 8) return _mm512_maskz_sqrt_pd(0xff, a);
#endif
#if defined(__AVX2__)
  if constexpr (N == 4) return _mm256_sqrt_pd(a);
#endif
#if defined(__x86_64__)
  if constexpr (N == 2) return _mm_sqrt_pd(a);
#endif
  Double<N> result{};
  for (int i = 0; i < N; ++i) set_lane(result, i, __builtin_sqrt(lane(a, i)));
  return result;
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
