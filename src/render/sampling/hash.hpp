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

}  // namespace microtrace::sampling
