#pragma once
/// Computes random numbers and pairs of them.

#include "render/lanes/surface_lanes.hpp"
#include "render/sampling/sobol.hpp"

namespace microtrace {

template <int N>
sampling::SobolLanes<N> load_sobol(const std::uint32_t* keys, const std::uint32_t* indices) {
  return {load_bits<N>(keys), load_bits<N>(indices)};
}

template <int N>
void random_pairs(const std::uint32_t* keys, const std::uint32_t* indices, std::uint32_t number,
                  float* x, float* y) {
  for (int i = 0; i < kShadingLanes; i += N) {
    const auto pair = load_sobol<N>(keys + i, indices + i).pair(number);
    store<N>(x + i, pair.x);
    store<N>(y + i, pair.y);
  }
}

/// Computes the first numbers of pairs.
template <int N>
void random_numbers(const std::uint32_t* keys, const std::uint32_t* indices, std::uint32_t number,
                    float* x) {
  for (int i = 0; i < kShadingLanes; i += N)
    store<N>(x + i, load_sobol<N>(keys + i, indices + i).one(number));
}

}  // namespace microtrace
