#pragma once
/// Samples positions within pixels.

#include "render/lanes/film_lanes.hpp"
#include "render/sampling/random_pairs.hpp"

namespace microtrace {

/// The coordinate of a FilterTable's filter, measured from the pixel's edge, for u in [0, 1].
template <int N>
Double<N> filtered_place(const FilterTable& table, const Double<N>& u) {
  constexpr int kSteps = FilterTable::kSteps;
  const Double<N> zero{}, one = zero + 1;
  const Double<N> from_half = magnitude(Double<N>(2 * u - 1));
  const Double<N> at = (one - square_root<N>(one - from_half)) * double(kSteps);
  Double<N> whole{}, reach{}, next{};
  for (int i = 0; i < N; ++i) {
    const auto step = static_cast<int>(lane(at, i));
    const int last = kSteps - 1, bounded = step < last ? step : last;
    set_lane(whole, i, static_cast<double>(bounded));
    set_lane(reach, i, table.reach[bounded]);
    set_lane(next, i, table.reach[bounded + 1]);
  }
  const Double<N> distance = reach + (at - whole) * (next - reach);
  return u < 0.5 ? 0.5 - distance : 0.5 + distance;
}

template <int N>
void sample_positions(const std::uint32_t* keys, const std::uint32_t* indices, std::uint32_t number,
                      const FilterTable* filter, double* x, double* y) {
  constexpr int kHalf = kDoubleLanes<N>;
  float u[kShadingLanes], v[kShadingLanes];
  random_pairs<N>(keys, indices, number, u, v);
  for (int i = 0; i < kShadingLanes; i += kHalf) {
    Double<kHalf> place_x = widened<kHalf>(u + i), place_y = widened<kHalf>(v + i);
    if (filter != nullptr) {
      place_x = filtered_place<kHalf>(*filter, place_x);
      place_y = filtered_place<kHalf>(*filter, place_y);
    }
    __builtin_memcpy(x + i, &place_x, sizeof place_x);
    __builtin_memcpy(y + i, &place_y, sizeof place_y);
  }
}

}  // namespace microtrace
