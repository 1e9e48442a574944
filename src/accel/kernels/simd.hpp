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

template <int N>
struct DoubleVector {
  typedef double type __attribute__((vector_size(8 * N)));
  typedef std::int64_t bits_type __attribute__((vector_size(8 * N)));
};
template <int N>
using Double = typename DoubleVector<N>::type;

using Lanes = std::uint32_t;

template <int N>
constexpr Lanes all_lanes = (Lanes{1} << N) - 1;

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
/// |a|, 0 for -0: the same bits under another type, but for the sign.
template <class V>
inline V magnitude(const V& a) {
  if constexpr (sizeof(a[0]) == 4)
    return (V)((typename FloatVector<sizeof(V) / 4>::bits_type) a & 0x7fffffff);
  else
    return (V)((typename DoubleVector<sizeof(V) / 8>::bits_type) a & 0x7fffffffffffffff);
}

/// Lanes of a, times -1 where b is negative or -0.
template <int N>
inline Float<N> with_sign_of(const Float<N>& a, const Float<N>& b) {
  using Bits = typename FloatVector<N>::bits_type;
  return (Float<N>)((Bits)a ^ ((Bits)b & INT32_MIN));
}

/// N float32 from memory as float64.
template <int N>
inline Double<N> widened(const float* p) {
  Float<N> v;
  __builtin_memcpy(&v, p, sizeof v);
  return __builtin_convertvector(v, Double<N>);
}

/// Rounded to float32, into memory.
template <int N>
inline void narrowed(const Double<N>& v, float* p) {
  const Float<N> rounded = __builtin_convertvector(v, Float<N>);
  __builtin_memcpy(p, &rounded, sizeof rounded);
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

#if defined(__AVX2__)
/// Eight numbers, each with its lane in the three lowest bits, the greatest first: the sorting
/// network of 19 exchanges in six steps (D. E. Knuth, The Art of Computer Programming 3, 5.3.4).
inline __m256i sorted_descending(__m256i v) {
// Lanes exchange with what `other` puts beside them; those of the mask keep the greater.
#define MICROTRACE_EXCHANGE(other, mask)                                          \
  {                                                                               \
    const __m256i w = other;                                                      \
    v = _mm256_blend_epi32(_mm256_min_epi32(v, w), _mm256_max_epi32(v, w), mask); \
  }
  const auto at = [](int a, int b, int c, int d, int e, int f, int g, int h) {
    return _mm256_setr_epi32(a, b, c, d, e, f, g, h);
  };
  MICROTRACE_EXCHANGE(_mm256_shuffle_epi32(v, 0x4E), 0x33)
  MICROTRACE_EXCHANGE(_mm256_permute2x128_si256(v, v, 1), 0x0F)
  MICROTRACE_EXCHANGE(_mm256_shuffle_epi32(v, 0xB1), 0x55)
  MICROTRACE_EXCHANGE(_mm256_permute4x64_epi64(v, 0xD8), 0x0C)
  MICROTRACE_EXCHANGE(_mm256_permutevar8x32_epi32(v, at(0, 4, 2, 6, 1, 5, 3, 7)), 0x0A)
  MICROTRACE_EXCHANGE(_mm256_permutevar8x32_epi32(v, at(0, 2, 1, 4, 3, 6, 5, 7)), 0x2A)
#undef MICROTRACE_EXCHANGE
  return v;
}
#endif

/// Writes the given lanes of eight keys, none of them negative, and of their values, by descending
/// key. Keys are rounded down by up to 7 ulp. Overwrites eight places.
inline void store_descending(Lanes lanes, const float* keys, const std::uint32_t* values,
                             float* to_keys, std::uint32_t* to_values) {
#if defined(__AVX2__)
  const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), low = _mm256_set1_epi32(7);
  const __m256i key =
      _mm256_or_si256(_mm256_andnot_si256(low, _mm256_castps_si256(_mm256_loadu_ps(keys))), lane);
#if defined(__AVX512VL__)
  const __m256i wanted =
      _mm256_mask_mov_epi32(_mm256_set1_epi32(-1), static_cast<__mmask8>(lanes), key);
#else
  const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  const __m256i set = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(lanes)), bit);
  const __m256i wanted = _mm256_or_si256(key, _mm256_cmpeq_epi32(set, _mm256_setzero_si256()));
#endif
  const __m256i order = sorted_descending(wanted);
  const __m256i all_values = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(values));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to_values),
                      _mm256_permutevar8x32_epi32(all_values, order));
  _mm256_storeu_ps(to_keys, _mm256_castsi256_ps(_mm256_andnot_si256(low, order)));
#else
  int size = 0;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = first_lane(lanes);
    int place = size++;
    for (; place > 0 && to_keys[place - 1] < keys[lane]; --place) {
      to_keys[place] = to_keys[place - 1];
      to_values[place] = to_values[place - 1];
    }
    to_keys[place] = keys[lane];
    to_values[place] = values[lane];
  }
#endif
}

/// Writes the given lanes of eight values one after another. May overwrite eight places.
inline void store_lanes(Lanes lanes, const std::uint32_t* values, std::uint32_t* to) {
#if defined(__AVX512VL__)
  const __m256i v = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(values));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                      _mm256_maskz_compress_epi32(static_cast<__mmask8>(lanes), v));
#else
  for (int lane = 0; lane < 8; ++lane) {
    *to = values[lane];
    to += lanes >> lane & 1U;
  }
#endif
}

}  // namespace
}  // namespace microtrace
