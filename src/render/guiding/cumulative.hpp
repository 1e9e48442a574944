#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace microtrace {

/// How many random numbers select an interval of cumulative probabilities.
inline constexpr std::uint32_t kCumulativeNumbers = 1U << 24U;

/// Sets bounds[i + 1] to the sum of the first i + 1 weights, as a fraction of `sum` in units of
/// 1 / kCumulativeNumbers. The sum of all weights must be positive and finite.
template <std::size_t n>
void accumulate_weights(const std::array<double, n>& weights, double sum,
                        std::array<std::uint32_t, n + 1>& bounds) {
  double below = 0;
  for (std::size_t i = 0; i < n; ++i) {
    below += weights[i];
    bounds[i + 1] =
        std::max(static_cast<std::uint32_t>(below / sum * kCumulativeNumbers), bounds[i]);
  }
  // The last interval with a weight gets what rounding left.
  for (std::size_t i = n; i-- > 0;) {
    bounds[i + 1] = kCumulativeNumbers;
    if (weights[i] > 0) break;
  }
}

}  // namespace microtrace
