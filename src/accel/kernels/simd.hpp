#pragma once
/// SIMD functions for tree traversal, in addition to simd/vectors.hpp.

#include "simd/vectors.hpp"

#include <cstddef>

namespace microtrace {
namespace {

/// Returns N of sixteen numbers, chosen by the lower four bits of their indices.
template <int N>
inline Float<N> picked(const float* sixteen, const std::uint8_t* indices) {
#if defined(__AVX2__)
  if constexpr (N == 4 || N == 8) {
    std::uint64_t bytes = 0;
    __builtin_memcpy(&bytes, indices, N);
    const __m256i index = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(bytes)));
    const __m256 low = _mm256_loadu_ps(sixteen), high = _mm256_loadu_ps(sixteen + 8);
#if defined(__AVX512VL__)
    const __m256 v = _mm256_permutex2var_ps(low, index, high);
#else
    const __m256 v = _mm256_blendv_ps(_mm256_permutevar8x32_ps(low, index),
                                      _mm256_permutevar8x32_ps(high, index),
                                      _mm256_castsi256_ps(_mm256_slli_epi32(index, 28)));
#endif
    if constexpr (N == 8)
      return v;
    else
      return _mm256_castps256_ps128(v);
  }
#endif
  Float<N> v{};
  for (int i = 0; i < N; ++i) set_lane(v, i, sixteen[indices[i] % 16U]);
  return v;
}

/// Returns table[indices[i]] in lane i, or any number if the index is not less than `count`, the
/// number of elements that are used.
template <int N, std::size_t kSize>
inline Double<N> looked_up(const double (&table)[kSize], [[maybe_unused]] std::uint32_t count,
                           const std::uint32_t* indices) {
  static_assert((kSize & (kSize - 1)) == 0 && kSize >= 16);
#if defined(__AVX512VL__)
  if constexpr (N == 8) {
    const __m256i index = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(indices));
    if (count <= 16)
      return _mm512_permutex2var_pd(_mm512_loadu_pd(table), _mm512_cvtepu32_epi64(index),
                                    _mm512_loadu_pd(table + 8));
    return _mm512_mask_i32gather_pd(
        _mm512_setzero_pd(), 0xff, _mm256_and_si256(index, _mm256_set1_epi32(kSize - 1)), table, 8);
  }
#endif
  Double<N> v{};
  for (int i = 0; i < N; ++i) set_lane(v, i, table[indices[i] % kSize]);
  return v;
}

template <int N>
inline void store_double(double* p, const Double<N>& v) {
  __builtin_memcpy(p, &v, sizeof v);
}

/// Stores a number in the elements of p that belong to the given lanes.
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

/// Combines all lanes by repeatedly combining the two halves of the vector. The result of `combine`
/// must not depend on the order.
template <int N, class Combine>
inline float combined(const Float<N>& v, const Combine& combine) {
  if constexpr (N == 1) {
    return v;
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
/// For each set of eight lanes, the indices of the lanes in the set in ascending order, one byte
/// each.
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

/// Stores the given lanes of eight values consecutively. May overwrite up to eight elements of
/// `to`.
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

/// Returns the lane with the least key among the given lanes of eight nonnegative keys. If no lane
/// is given, returns any number up to 7. Keys that differ only in their last three bits count as
/// equal.
inline int least_lane(Lanes lanes, const float* keys) {
#if defined(__AVX2__)
  // Replaces the last three bits of each key by the index of its lane.
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

/// Returns the lanes whose numbers are within [first, last].
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

/// Returns the lanes whose numbers have this value.
template <int N>
inline Lanes equal_to(const std::uint32_t* numbers, std::uint32_t value) {
#if defined(__AVX512VL__)
  if constexpr (N == 16)
    return _mm512_cmpeq_epi32_mask(_mm512_loadu_si512(numbers),
                                   _mm512_set1_epi32(static_cast<int>(value)));
#endif
  Lanes lanes = 0;
  if constexpr (N % 8 == 0) {
    for (int i = 0; i < N; i += 8) lanes |= lanes_within(numbers + i, value, value) << i;
  } else {
    for (int i = 0; i < N; ++i) lanes |= static_cast<Lanes>(numbers[i] == value) << i;
  }
  return lanes;
}

}  // namespace
}  // namespace microtrace
