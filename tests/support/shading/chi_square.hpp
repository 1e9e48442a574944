#pragma once
/// Pearson's chi-square test of counts against expectations.

#include <cmath>
#include <cstddef>
#include <span>

namespace microtrace {

/// Returns by how many standard deviations the statistic exceeds its mean, using the cube-root
/// approximation of E. Wilson and M. Hilferty (The distribution of chi-square, 1931). Pools cells
/// whose expected count is below 5.
inline double chi_square_excess(std::span<const double> counts, std::span<const double> expected) {
  double statistic = 0, pooled_count = 0, pooled = 0, cells = 0;
  const auto add = [&](double count, double mean) {
    statistic += (count - mean) * (count - mean) / mean;
    ++cells;
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] >= 5) {
      add(counts[i], expected[i]);
    } else {
      pooled_count += counts[i];
      pooled += expected[i];
    }
  }
  if (pooled >= 5) add(pooled_count, pooled);
  const double k = cells - 1, variance = 2 / (9 * k);
  return (std::cbrt(statistic / k) - (1 - variance)) / std::sqrt(variance);
}

}  // namespace microtrace
