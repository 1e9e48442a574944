#pragma once
/// Integer hashes of uint32, or of lanes of uint32.

#include <cstdint>

namespace microtrace::sampling {

/// A bijection of 32 bits in which each input bit affects every output bit (C. Wellons, Prospecting
/// for hash functions, 2018: "lowbias32").
template <class Bits>
constexpr Bits mixed(Bits x) {
  x ^= x >> 16U;
  x *= 0x7feb352dU;
  x ^= x >> 15U;
  x *= 0x846ca68bU;
  x ^= x >> 16U;
  return x;
}

template <class Bits>
constexpr Bits hash(const Bits& key, std::uint32_t value) {
  return mixed(Bits(key ^ mixed(value + 0x9e3779b9U)));
}

template <class Bits>
constexpr Bits reversed_bits(Bits x) {
  x = (x & 0x55555555U) << 1U | (x >> 1U & 0x55555555U);
  x = (x & 0x33333333U) << 2U | (x >> 2U & 0x33333333U);
  x = (x & 0x0f0f0f0fU) << 4U | (x >> 4U & 0x0f0f0f0fU);
  x = (x & 0x00ff00ffU) << 8U | (x >> 8U & 0x00ff00ffU);
  return x << 16U | x >> 16U;
}

}  // namespace microtrace::sampling
