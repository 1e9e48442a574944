#pragma once
/// Low-discrepancy random numbers, each a pure function of seed, pixel, sample and dimension.

#include "render/sampling/hash.hpp"
#include "simd/bit_reversal.hpp"
#include "simd/vector3.hpp"

#include <microtrace/math.hpp>

#include <cstdint>

namespace microtrace::sampling {

/// The second dimension of the Sobol sequence for the index x, with its bits in reverse order. The
/// generator matrix is Pascal's triangle modulo 2, which is applied by recursive halving.
template <class Bits>
constexpr Bits sobol_upwards(Bits x) {
  x ^= (x & 0xaaaaaaaaU) >> 1U;
  x ^= (x & 0xccccccccU) >> 2U;
  x ^= (x & 0xf0f0f0f0U) >> 4U;
  x ^= (x & 0xff00ff00U) >> 8U;
  x ^= (x & 0xffff0000U) >> 16U;
  return x;
}

/// Flips each bit depending on the lower bits. This is Owen scrambling of a number whose bits are
/// reversed (S. Laine and T. Karras, Stratified sampling for stochastic transparency, 2011;
/// constants by N. Vegdahl, Building a better LK hash, 2021).
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

/// The random numbers of N samples, one in each lane. Dimensions come in pairs. For each pair, the
/// samples of a pixel form a (0, 2)-sequence with its own Owen scrambling and its own order, so
/// different pairs are independent (B. Burley, Practical hash-based Owen scrambling, 2020).
template <int N>
class SobolLanes {
 public:
  using Bits = Unsigned<N>;

  SobolLanes() = default;
  /// Constructs samples from their pixels' pixel_key()s and their indices within the pixels.
  SobolLanes(const Bits& key, const Bits& index) : key_(key), index_(reversed_bits(index)) {}

  [[nodiscard]] Bits key() const { return key_; }
  [[nodiscard]] Bits index() const { return reversed_bits(index_); }

  /// The two numbers of this pair, in [0, 1).
  [[nodiscard]] Floats2<N> pair(std::uint32_t number) const {
    const Bits key = hash(key_, number), n = place(key);
    return {first(n, key), unit_float(scrambled_upwards(sobol_upwards(n), hash(key, 2)))};
  }

  /// The first number of this pair, in [0, 1).
  [[nodiscard]] Float<N> one(std::uint32_t number) const {
    const Bits key = hash(key_, number);
    return first(place(key), key);
  }

 private:
  /// The sample's place in the order of a pair.
  [[nodiscard]] Bits place(const Bits& key) const {
    return reversed_bits(scrambled_upwards(index_, key));
  }
  /// The first dimension of the Sobol sequence is the bit-reversed index.
  [[nodiscard]] static Float<N> first(const Bits& n, const Bits& key) {
    return unit_float(scrambled_upwards(n, hash(key, 1)));
  }
  /// Converts bits to a float in [0, 1). The lowest bit is the most significant one.
  static Float<N> unit_float(const Bits& upwards) {
    return to_float<N>(reinterpreted<Int<N>>(Bits(reversed_bits(upwards) >> 8U))) * 0x1p-24F;
  }

  Bits key_{}, index_{};
};

using Sobol = SobolLanes<1>;

}  // namespace microtrace::sampling
