#pragma once
/// sampling::Sobol for N samples.

#include "render/kernels/kernel.hpp"
#include "simd/vectors.hpp"

namespace microtrace {
namespace {

template <int N>
inline Unsigned<N> load(const std::uint32_t* p) {
  Unsigned<N> v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}

template <int N>
struct SobolLanes {
  using U = Unsigned<N>;
  using F = Float<N>;

  U key, index;  ///< index: bits reversed

  SobolLanes(const std::uint32_t* keys, const std::uint32_t* indices)
      : key(load<N>(keys)), index(reversed_bits(load<N>(indices))) {}

  template <class Numbers>
  static Numbers mixed(Numbers x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    x ^= x >> 16;
    return x;
  }
  static U hash(const U& key, std::uint32_t value) {
    return mixed(key ^ mixed(value + 0x9e3779b9U));
  }
  static U reversed_bits(U x) {
    x = (x & 0x55555555U) << 1 | (x >> 1 & 0x55555555U);
    x = (x & 0x33333333U) << 2 | (x >> 2 & 0x33333333U);
    x = (x & 0x0f0f0f0fU) << 4 | (x >> 4 & 0x0f0f0f0fU);
    x = (x & 0x00ff00ffU) << 8 | (x >> 8 & 0x00ff00ffU);
    return x << 16 | x >> 16;
  }
  static U scrambled_upwards(U x, const U& seed) {
    x ^= x * 0x3d20adeaU;
    x += seed;
    x *= (seed >> 16) | 1U;
    x ^= x * 0x05526c56U;
    x ^= x * 0x53a22864U;
    return x;
  }
  /// The bits of the second dimension, lowest first: Pascal's triangle modulo 2, by halves.
  static U sobol_upwards(U x) {
    x ^= (x & 0xaaaaaaaaU) >> 1;
    x ^= (x & 0xccccccccU) >> 2;
    x ^= (x & 0xf0f0f0f0U) >> 4;
    x ^= (x & 0xff00ff00U) >> 8;
    x ^= (x & 0xffff0000U) >> 16;
    return x;
  }
  /// A float in [0, 1) from bits in ascending order.
  static F unit_float(const U& upwards) {
    using Bits = typename FloatVector<N>::bits_type;
    return __builtin_convertvector((Bits)(reversed_bits(upwards) >> 8), F) * 0x1p-24F;
  }

  struct Pair {
    F x, y;
  };
  [[nodiscard]] Pair pair(std::uint32_t number) const {
    const U pair_key = hash(key, number);
    const U n = reversed_bits(scrambled_upwards(index, pair_key));
    return {unit_float(scrambled_upwards(n, hash(pair_key, 1))),
            unit_float(scrambled_upwards(sobol_upwards(n), hash(pair_key, 2)))};
  }
};

template <int N>
void random_pairs(const std::uint32_t* keys, const std::uint32_t* indices, std::uint32_t number,
                  float* x, float* y) {
  for (int i = 0; i < kShadingLanes; i += N) {
    const auto pair = SobolLanes<N>(keys + i, indices + i).pair(number);
    store<N>(x + i, pair.x);
    store<N>(y + i, pair.y);
  }
}

}  // namespace
}  // namespace microtrace
