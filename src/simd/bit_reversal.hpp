#pragma once
/// Reverses the order of the 32 bits of numbers, or of lanes of numbers.

#include "simd/vectors.hpp"

#include <cstdint>

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

template <class Bits>
constexpr Bits reversed_bits(Bits x) {
  x = (x & 0x55555555U) << 1U | (x >> 1U & 0x55555555U);
  x = (x & 0x33333333U) << 2U | (x >> 2U & 0x33333333U);
  x = (x & 0x0f0f0f0fU) << 4U | (x >> 4U & 0x0f0f0f0fU);
  x = (x & 0x00ff00ffU) << 8U | (x >> 8U & 0x00ff00ffU);
  return x << 16U | x >> 16U;
}

#if defined(__AVX2__)
/// Tables for shuffles within sixteen bytes, repeated for each part of a vector.
struct ReversalTables {
  alignas(64) unsigned char bits[64];   ///< the reversed bits of the numbers 0 to 15
  alignas(64) unsigned char bytes[64];  ///< the places of the reversed bytes of four numbers
};
inline constexpr ReversalTables kReversal = [] {
  ReversalTables tables{};
  for (std::uint32_t i = 0; i < 64; ++i) {
    tables.bits[i] = static_cast<unsigned char>(reversed_bits(i % 16) >> 28U);
    tables.bytes[i] = static_cast<unsigned char>(i % 16 ^ 3U);
  }
  return tables;
}();

// These look up the reversed halves of each byte, then reverse the bytes of each lane.
inline Unsigned<8> reversed_bits(const Unsigned<8>& x) {
  const auto table = [](const unsigned char* p) {
    return _mm256_load_si256(reinterpret_cast<const __m256i*>(p));
  };
  const __m256i v = (__m256i)x, low = _mm256_set1_epi8(15), bits = table(kReversal.bits);
  const __m256i lower = _mm256_shuffle_epi8(bits, _mm256_and_si256(v, low));
  const __m256i upper = _mm256_shuffle_epi8(bits, _mm256_and_si256(_mm256_srli_epi16(v, 4), low));
  const __m256i reversed = _mm256_or_si256(_mm256_slli_epi16(lower, 4), upper);
  return (Unsigned<8>)_mm256_shuffle_epi8(reversed, table(kReversal.bytes));
}
#endif
#if defined(__AVX512BW__)
inline Unsigned<16> reversed_bits(const Unsigned<16>& x) {
  const __m512i v = (__m512i)x, low = _mm512_set1_epi8(15);
  const __m512i bits = _mm512_load_si512(kReversal.bits);
  const __m512i lower = _mm512_shuffle_epi8(bits, _mm512_and_si512(v, low));
  const __m512i upper = _mm512_shuffle_epi8(bits, _mm512_and_si512(_mm512_srli_epi16(v, 4), low));
  const __m512i reversed = _mm512_or_si512(_mm512_slli_epi16(lower, 4), upper);
  return (Unsigned<16>)_mm512_shuffle_epi8(reversed, _mm512_load_si512(kReversal.bytes));
}
#endif

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
