#pragma once
/// SIMD vectors of float32 and float64 for all kernels. `Float<N>` is the vector extension of GCC
/// and Clang: N lanes, with + - * / and ?: per lane. N is 4, 8 or 16: at most the register width of
/// the instruction set for which the including file is compiled. All widths give the same bits,
/// because every operation is defined by IEEE 754. A set of lanes is an integer with one bit per
/// lane.
///
/// Everything has internal linkage, so that the linker can't merge code of different instruction
/// sets.

#include <cstdint>

#if defined(__x86_64__)
#include <immintrin.h>
#else
#include <cmath>
#endif

namespace microtrace {
namespace {

template <int N>
struct FloatVector {
  typedef float type __attribute__((vector_size(4 * N)));
  typedef std::int32_t bits_type __attribute__((vector_size(4 * N)));
};
template <int N>
using Float = typename FloatVector<N>::type;

template <int N>
struct UnsignedVector {
  typedef std::uint32_t type __attribute__((vector_size(4 * N)));
};
template <int N>
using Unsigned = typename UnsignedVector<N>::type;

template <int N>
struct DoubleVector {
  typedef double type __attribute__((vector_size(8 * N)));
  typedef std::int64_t bits_type __attribute__((vector_size(8 * N)));
};
template <int N>
using Double = typename DoubleVector<N>::type;

using Lanes = std::uint32_t;

template <int N>
constexpr Lanes kAllLanes = (Lanes{1} << N) - 1;

template <int N>
inline Float<N> load(const float* p) {
  Float<N> v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}

template <int N>
inline void store(float* p, const Float<N>& v) {
  __builtin_memcpy(p, &v, sizeof v);
}

template <int N>
inline Float<N> all(float x) {
  return x - Float<N>{};  // x - 0 is x, including -0 and NaN
}

/// a where a < b, else b. If one of them is NaN the result is b, like x86's min instruction.
template <class V>
inline V lesser(const V& a, const V& b) {
  return a < b ? a : b;
}
template <class V>
inline V greater(const V& a, const V& b) {
  return a > b ? a : b;
}
/// |a|, and 0 for -0: clears the sign bit.
template <class V>
inline V magnitude(const V& a) {
  if constexpr (sizeof(a[0]) == 4)
    return (V)((typename FloatVector<sizeof(V) / 4>::bits_type) a & 0x7fffffff);
  else
    return (V)((typename DoubleVector<sizeof(V) / 8>::bits_type) a & 0x7fffffffffffffff);
}

/// Lanes of a, negated where b is negative or -0.
template <int N>
inline Float<N> with_sign_of(const Float<N>& a, const Float<N>& b) {
  using Bits = typename FloatVector<N>::bits_type;
  return (Float<N>)((Bits)a ^ ((Bits)b & INT32_MIN));
}

/// Loads N float32 as float64.
template <int N>
inline Double<N> widened(const float* p) {
  Float<N> v;
  __builtin_memcpy(&v, p, sizeof v);
  return __builtin_convertvector(v, Double<N>);
}

/// Rounds to float32 and stores.
template <int N>
inline void narrowed(const Double<N>& v, float* p) {
  const Float<N> rounded = __builtin_convertvector(v, Float<N>);
  __builtin_memcpy(p, &rounded, sizeof rounded);
}

/// Moves positive finite lanes by n units in the last place.
template <int N>
inline Float<N> moved_by_ulps(const Float<N>& a, int n) {
  using Bits = typename FloatVector<N>::bits_type;
  return (Float<N>)((Bits)a + n);
}

/// The lanes in which a <= b; false for NaN.
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
  for (int i = 0; i < N; ++i) lanes |= static_cast<Lanes>(a[i] <= b[i]) << i;
  return lanes;
}

/// The lanes in which a < b; false for NaN.
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
  for (int i = 0; i < N; ++i) lanes |= static_cast<Lanes>(a[i] < b[i]) << i;
  return lanes;
}

/// Integer lanes with all bits set in the given lanes, zero in the others.
template <int N>
inline auto mask_of(Lanes lanes) {
  using Bits = typename FloatVector<N>::bits_type;
  Bits bit{};
  for (int i = 0; i < N; ++i) bit[i] = 1 << i;
  return (bit & static_cast<std::int32_t>(lanes)) != 0;
}

/// a in the given lanes, b in the others.
template <int N>
inline Float<N> select(Lanes lanes, const Float<N>& a, const Float<N>& b) {
#if defined(__AVX512VL__)
  if constexpr (N == 16) return _mm512_mask_blend_ps(static_cast<__mmask16>(lanes), b, a);
  if constexpr (N == 8) return _mm256_mask_blend_ps(static_cast<__mmask8>(lanes), b, a);
#endif
  return mask_of<N>(lanes) ? a : b;
}

/// Square roots, correctly rounded by IEEE 754.
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
#else
  Float<N> result;
  for (int i = 0; i < N; ++i) result[i] = std::sqrt(a[i]);
  return result;
#endif
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
#else
  Double<N> result;
  for (int i = 0; i < N; ++i) result[i] = std::sqrt(a[i]);
  return result;
#endif
}

}  // namespace
}  // namespace microtrace
