#pragma once
/// Low-discrepancy random numbers, each a pure function of seed, pixel, sample and dimension.

#include "render/sampling/hash.hpp"
#include "simd/vector3.hpp"

#include <microtrace/math.hpp>

#include <cstdint>

namespace microtrace::sampling {

/// The bits of the second dimension of the Sobol sequence, lowest first, for an index: its
/// generator matrix is Pascal's triangle modulo 2, applied by halves.
template <class Bits>
constexpr Bits sobol_upwards(Bits x) {
  x ^= (x & 0xaaaaaaaaU) >> 1U;
  x ^= (x & 0xccccccccU) >> 2U;
  x ^= (x & 0xf0f0f0f0U) >> 4U;
  x ^= (x & 0xff00ff00U) >> 8U;
  x ^= (x & 0xffff0000U) >> 16U;
  return x;
}

/// Scrambles each bit by the lower ones: Owen scrambling of a number whose bits are reversed (S.
/// Laine and T. Karras, Stratified sampling for stochastic transparency, 2011; constants by N.
/// Vegdahl, Building a better LK hash, 2021).
template <class Bits>
constexpr Bits scrambled_upwards(Bits x, const Bits& seed) {
  x ^= x * 0x3d20adeaU;
  x += seed;
  x *= (seed >> 16U) | 1U;
  x ^= x * 0x05526c56U;
  x ^= x * 0x53a22864U;
  return x;
}

/// The key of a pixel's random numbers.
constexpr std::uint32_t pixel_key(std::uint32_t seed, std::uint32_t x, std::uint32_t y) {
  return hash(hash(hash(seed, x), y), 0x9e3779b9U);
}

/// The random numbers of one sample of one pixel, for N samples. Dimensions come in pairs; each
/// pair of a pixel's samples is a (0, 2)-sequence with its own Owen scrambling and its own order,
/// so that different pairs are independent (B. Burley, Practical hash-based Owen scrambling, 2020).
template <int N>
class SobolLanes {
 public:
  using Bits = Unsigned<N>;

  SobolLanes() = default;
  /// Samples of pixels with these pixel_key()s.
  SobolLanes(const Bits& key, const Bits& index) : key_(key), index_(reversed_bits(index)) {}

  [[nodiscard]] Bits key() const { return key_; }
  [[nodiscard]] Bits index() const { return reversed_bits(index_); }

  /// Two numbers in [0, 1) for this pair.
  [[nodiscard]] Floats2<N> pair(std::uint32_t number) const {
    const Bits key = hash(key_, number);
    const Bits n = reversed_bits(scrambled_upwards(index_, key));
    // The first dimension is the bit-reversed index.
    return {unit_float(scrambled_upwards(n, hash(key, 1))),
            unit_float(scrambled_upwards(sobol_upwards(n), hash(key, 2)))};
  }

  /// One number in [0, 1), the first dimension of this pair.
  [[nodiscard]] Float<N> one(std::uint32_t number) const { return pair(number).x; }

 private:
  /// A float in [0, 1) from bits of which the lowest is the most significant.
  static Float<N> unit_float(const Bits& upwards) {
    return to_float<N>(reinterpreted<Int<N>>(Bits(reversed_bits(upwards) >> 8U))) * 0x1p-24F;
  }

  Bits key_{}, index_{};
};

using Sobol = SobolLanes<1>;

}  // namespace microtrace::sampling
