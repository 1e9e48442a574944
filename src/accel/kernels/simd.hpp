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

/// Integer lanes: all bits set in the given ones.
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

/// Writes a number to the given lanes' places.
template <int N>
inline void store_where(Lanes lanes, std::uint32_t number, std::uint32_t* p) {
#if defined(__AVX512VL__)
  if constexpr (N == 16)
    return _mm512_mask_storeu_epi32(p, static_cast<__mmask16>(lanes),
                                    _mm512_set1_epi32(static_cast<int>(number)));
#endif
  using Bits = typename FloatVector<N>::bits_type;
  Bits v;
  __builtin_memcpy(&v, p, sizeof v);
  v = mask_of<N>(lanes) ? Bits{} + static_cast<std::int32_t>(number) : v;
  __builtin_memcpy(p, &v, sizeof v);
}

/// combine of all lanes, halving the vector as often as needed. combine must not depend on order.
template <int N, class Combine>
inline float combined(const Float<N>& v, const Combine& combine) {
  if constexpr (N == 1) {
    return v[0];
  } else {
    float lanes[N];
    store<N>(lanes, v);
    return combined<N / 2>(combine(load<N / 2>(lanes), load<N / 2>(lanes + N / 2)), combine);
  }
}
template <int N>
inline float least_of(const Float<N>& v) {
  return combined<N>(v, [](const auto& a, const auto& b) { return lesser(a, b); });
}
template <int N>
inline float greatest_of(const Float<N>& v) {
  return combined<N>(v, [](const auto& a, const auto& b) { return greater(a, b); });
}

inline int first_lane(std::uint64_t lanes) {
  return __builtin_ctzll(lanes);
}

#if defined(__AVX2__) && !defined(__AVX512VL__)
/// For each set of eight lanes their numbers, a byte each, the lowest first.
struct PackingTable {
  std::uint64_t order[256];
};
constexpr PackingTable kPacking = [] {
  PackingTable table{};
  for (unsigned lanes = 0; lanes < 256; ++lanes) {
    unsigned count = 0;
    for (unsigned lane = 0; lane < 8; ++lane) {
      if ((lanes >> lane & 1U) != 0) table.order[lanes] |= std::uint64_t{lane} << (8 * count++);
    }
  }
  return table;
}();
#endif

/// Writes the given lanes of eight values one after another. May overwrite eight places.
template <class T>
inline void store_lanes(Lanes lanes, const T* values, T* to) {
  static_assert(sizeof(T) == 4);
#if defined(__AVX512VL__)
  const __m256i v = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(values));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                      _mm256_maskz_compress_epi32(static_cast<__mmask8>(lanes), v));
#elif defined(__AVX2__)
  const __m256i order =
      _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(kPacking.order[lanes])));
  const __m256i v = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(values));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(v, order));
#else
  for (int lane = 0; lane < 8; ++lane) {
    *to = values[lane];
    to += lanes >> lane & 1U;
  }
#endif
}

/// Of the given lanes that with the least of eight keys, none of which is negative; without lanes
/// some number up to 7.
/// Keys that differ in their last three bits alone count as equal.
inline int least_lane(Lanes lanes, const float* keys) {
#if defined(__AVX2__)
  // The lane's number in the key's last bits.
  const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256i bits = _mm256_castps_si256(_mm256_loadu_ps(keys));
  const __m256i key = _mm256_or_si256(_mm256_andnot_si256(_mm256_set1_epi32(7), bits), lane);
#if defined(__AVX512VL__)
  __m256i v =
      _mm256_mask_mov_epi32(_mm256_set1_epi32(INT32_MAX), static_cast<__mmask8>(lanes), key);
#else
  const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  const __m256i set = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(lanes)), bit);
  __m256i v = _mm256_blendv_epi8(_mm256_set1_epi32(INT32_MAX), key, _mm256_cmpeq_epi32(set, bit));
#endif
  __m128i least = _mm_min_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
  least = _mm_min_epi32(least, _mm_shuffle_epi32(least, 0x4E));
  least = _mm_min_epi32(least, _mm_shuffle_epi32(least, 0xB1));
  return _mm_cvtsi128_si32(least) & 7;
#else
  if (lanes == 0) return 0;
  int least = first_lane(lanes);
  for (lanes &= lanes - 1; lanes != 0; lanes &= lanes - 1) {
    if (keys[first_lane(lanes)] < keys[least]) least = first_lane(lanes);
  }
  return least;
#endif
}

/// Which of eight numbers are within [first, last].
inline Lanes lanes_within(const std::uint32_t* numbers, std::uint32_t first, std::uint32_t last) {
#if defined(__AVX2__)
  typedef std::uint32_t Numbers __attribute__((vector_size(32)));
  Numbers v;
  __builtin_memcpy(&v, numbers, sizeof v);
#endif
#if defined(__AVX512VL__)
  const Numbers from = v - first, size = Numbers{} + (last - first);
  return _mm256_cmple_epu32_mask((__m256i)from, (__m256i)size);
#elif defined(__AVX2__)
  const auto inside = (v - first) <= (last - first);
  return static_cast<Lanes>(_mm256_movemask_ps((__m256)inside));
#else
  Lanes lanes = 0;
  for (int lane = 0; lane < 8; ++lane)
    lanes |= static_cast<Lanes>(numbers[lane] - first <= last - first) << lane;
  return lanes;
#endif
}

}  // namespace
}  // namespace microtrace
