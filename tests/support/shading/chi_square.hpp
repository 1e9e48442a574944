#pragma once
/// Pearson's chi-square test of counts against expectations.

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace microtrace {

/// Returns by how many standard deviations the statistic exceeds its mean, using the cube-root
/// approximation of E. Wilson and M. Hilferty (The distribution of chi-square, 1931). Pools cells
/// whose expected count is below 5, and adds them to another cell if all of them together expect
/// less. Infinite if there are counts where none is possible.
inline double chi_square_excess(std::span<const double> counts, std::span<const double> expected) {
  struct Cell {
    double count = 0, mean = 0;
  };
  std::vector<Cell> cells;
  Cell pool;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] == 0 && counts[i] > 0) return std::numeric_limits<double>::infinity();
    if (expected[i] >= 5)
      cells.push_back({.count = counts[i], .mean = expected[i]});
    else
      pool = {.count = pool.count + counts[i], .mean = pool.mean + expected[i]};
  }
  if (pool.mean >= 5 || cells.empty()) {
    cells.push_back(pool);
  } else {
    cells.back().count += pool.count;
    cells.back().mean += pool.mean;
  }
  double statistic = 0;
  for (const auto& [count, mean] : cells) statistic += (count - mean) * (count - mean) / mean;
  const double k = static_cast<double>(cells.size()) - 1, variance = 2 / (9 * k);
  return (std::cbrt(statistic / k) - (1 - variance)) / std::sqrt(variance);
}

}  // namespace microtrace
