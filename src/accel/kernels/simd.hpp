#pragma once
/// Vectors of float32; the only file that names an intrinsic. `Float<N>` is the vector extension of
/// GCC and Clang: N lanes, with + - * / and ?: lane by lane. N is 4, 8 or 16: the widest register
/// of the instruction set that the including file is compiled for, or less. All give the same bits,
/// since every operation is IEEE 754's. A set of lanes is a number with a bit for each.
///
/// Everything has internal linkage: the linker must never take code of one instruction set for
/// another's.

#include <cstdint>

#if defined(__x86_64__)
#include <immintrin.h>
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
  return x - Float<N>{};  // x - 0 is x, -0 and NaN included
}

/// a where a < b, else b: b where one of them is NaN, as x86's instruction does.
template <class V>
inline V lesser(const V& a, const V& b) {
  return a < b ? a : b;
}
template <class V>
inline V greater(const V& a, const V& b) {
  return a > b ? a : b;
}
/// |a|, 0 for -0.
template <class V>
inline V magnitude(const V& a) {
  using Bits = typename FloatVector<sizeof(V) / 4>::bits_type;
  return (V)((Bits)a & 0x7fffffff);  // the same bits under another type
}

/// Positive finite lanes moved by n units in the last place.
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

/// a in the given lanes, b in the others.
template <int N>
inline Float<N> select(Lanes lanes, const Float<N>& a, const Float<N>& b) {
#if defined(__AVX512VL__)
  if constexpr (N == 16) return _mm512_mask_blend_ps(static_cast<__mmask16>(lanes), b, a);
  if constexpr (N == 8) return _mm256_mask_blend_ps(static_cast<__mmask8>(lanes), b, a);
#endif
  using Bits = typename FloatVector<N>::bits_type;
  Bits bit{};
  for (int i = 0; i < N; ++i) bit[i] = 1 << i;
  const Bits set = bit & static_cast<std::int32_t>(lanes);
  return set != 0 ? a : b;
}

inline int first_lane(std::uint64_t lanes) {
  return __builtin_ctzll(lanes);
}

}  // namespace
}  // namespace microtrace
