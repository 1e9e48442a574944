#pragma once
/// Pseudorandom bits that depend only on their place in a sequence.

#include <cstdint>

namespace microtrace {

/// Returns number n, counted from 1, of the sequence of SplitMix64 with this seed (G. Steele, D.
/// Lea and C. Flood, Fast splittable pseudorandom number generators, OOPSLA 2014).
[[nodiscard]] constexpr std::uint64_t split_mix(std::uint64_t n, std::uint64_t seed = 0) {
  std::uint64_t z = seed + n * 0x9E3779B97F4A7C15U;
  z = (z ^ z >> 30U) * 0xBF58476D1CE4E5B9U;
  z = (z ^ z >> 27U) * 0x94D049BB133111EBU;
  return z ^ z >> 31U;
}

}  // namespace microtrace
