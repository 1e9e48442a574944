#pragma once
/// Mixing of integers.

#include <cstdint>

namespace microtrace::sampling {

/// A bijection of 32 bits in which each bit of x moves every other (C. Wellons, Prospecting for
/// hash functions, 2018: "lowbias32").
constexpr std::uint32_t mixed(std::uint32_t x) {
  x ^= x >> 16U;
  x *= 0x7feb352dU;
  x ^= x >> 15U;
  x *= 0x846ca68bU;
  x ^= x >> 16U;
  return x;
}

constexpr std::uint32_t hash(std::uint32_t key, std::uint32_t value) {
  return mixed(key ^ mixed(value + 0x9e3779b9U));
}

}  // namespace microtrace::sampling
