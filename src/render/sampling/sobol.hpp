#pragma once
/// Low-discrepancy random numbers, each a pure function of seed, pixel, sample and dimension.

#include "render/sampling/hash.hpp"

#include <microtrace/math.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace microtrace::sampling {

namespace detail {

/// sobol_y(n) is the xor of one entry of each table, indexed by the bytes of n: the second
/// dimension of the Sobol sequence, whose generator matrix is Pascal's triangle modulo 2.
using ByteTables = std::array<std::array<std::uint32_t, 256>, 4>;

constexpr ByteTables make_byte_tables() {
  std::array<std::uint32_t, 32> columns{};
  columns[0] = 1U << 31U;
  for (std::size_t k = 1; k < 32; ++k) columns[k] = columns[k - 1] ^ (columns[k - 1] >> 1U);
  ByteTables tables{};
  for (std::size_t byte = 0; byte < 4; ++byte) {
    for (std::size_t value = 0; value < 256; ++value) {
      for (std::size_t bit = 0; bit < 8; ++bit) {
        if ((value >> bit & 1U) != 0) tables[byte][value] ^= columns[8 * byte + bit];
      }
    }
  }
  return tables;
}
inline constexpr ByteTables kSecondDimension = make_byte_tables();

constexpr std::uint32_t sobol_y(std::uint32_t n) {
  return kSecondDimension[0][n & 255U] ^ kSecondDimension[1][n >> 8U & 255U] ^
         kSecondDimension[2][n >> 16U & 255U] ^ kSecondDimension[3][n >> 24U];
}

/// Scrambles each bit by the lower ones: Owen scrambling of a number whose bits are reversed (S.
/// Laine and T. Karras, Stratified sampling for stochastic transparency, 2011; constants by N.
/// Vegdahl, Building a better LK hash, 2021).
constexpr std::uint32_t scrambled_upwards(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeaU;
  x += seed;
  x *= (seed >> 16U) | 1U;
  x ^= x * 0x05526c56U;
  x ^= x * 0x53a22864U;
  return x;
}

/// A float in [0, 1) from the upper 24 bits.
constexpr float unit_float(std::uint32_t x) {
  return static_cast<float>(x >> 8U) * 0x1p-24F;
}

}  // namespace detail

/// The key of a pixel's random numbers.
constexpr std::uint32_t pixel_key(std::uint32_t seed, std::uint32_t x, std::uint32_t y) {
  return hash(hash(hash(seed, x), y), 0x9e3779b9U);
}

/// The random numbers of one sample of one pixel. Dimensions come in pairs; each pair of a pixel's
/// samples is a (0, 2)-sequence with its own Owen scrambling and its own order, so that different
/// pairs are independent (B. Burley, Practical hash-based Owen scrambling, 2020).
class Sobol {
 public:
  Sobol() = default;
  /// A sample of the pixel with this pixel_key().
  Sobol(std::uint32_t key, std::uint32_t index) : key_(key), index_(reversed_bits(index)) {}

  [[nodiscard]] std::uint32_t key() const { return key_; }
  [[nodiscard]] std::uint32_t index() const { return reversed_bits(index_); }

  /// Two numbers in [0, 1) for this pair.
  [[nodiscard]] Vec2 pair(std::uint32_t number) const {
    using namespace detail;
    const std::uint32_t key = hash(key_, number);
    const std::uint32_t n = reversed_bits(scrambled_upwards(index_, key));
    // The first dimension is the bit-reversed index.
    const std::uint32_t x = reversed_bits(scrambled_upwards(n, hash(key, 1)));
    const std::uint32_t y =
        reversed_bits(scrambled_upwards(reversed_bits(sobol_y(n)), hash(key, 2)));
    return {unit_float(x), unit_float(y)};
  }

  /// One number in [0, 1), the first dimension of this pair.
  [[nodiscard]] float one(std::uint32_t number) const {
    using namespace detail;
    const std::uint32_t key = hash(key_, number);
    const std::uint32_t n = reversed_bits(scrambled_upwards(index_, key));
    return unit_float(reversed_bits(scrambled_upwards(n, hash(key, 1))));
  }

 private:
  std::uint32_t key_ = 0, index_ = 0;
};

}  // namespace microtrace::sampling
