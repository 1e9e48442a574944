#pragma once
#include <algorithm>
#include <array>
#include <cstddef>

namespace microtrace {

/// A grid of numbers in rows. The last column of a round grid is a neighbor of the first.
struct BlurredGrid {
  int rows, columns;
  bool is_round;
  int center;  ///< weight of a number along each axis; its neighbors have a weight of 1

  /// The sum of the weights of a number and its neighbors.
  [[nodiscard]] constexpr int weight() const { return (center + 2) * (center + 2); }
};

/// Replaces each number by a weighted sum of itself and its neighbors. Those at an edge are their
/// own neighbors.
template <class T, std::size_t n>
[[nodiscard]] std::array<T, n> blurred(const std::array<T, n>& values, const BlurredGrid& grid) {
  std::array<T, n> result{};
  const auto at = [&](int row, int column) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
           static_cast<std::size_t>(column);
  };
  const auto weight = [&](int distance) { return distance == 0 ? grid.center : 1; };
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      T sum = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        const int y = std::clamp(row + dy, 0, grid.rows - 1);
        for (int dx = -1; dx <= 1; ++dx) {
          const int x = grid.is_round ? (column + dx + grid.columns) % grid.columns
                                      : std::clamp(column + dx, 0, grid.columns - 1);
          sum += static_cast<T>(weight(dx) * weight(dy)) * values[at(y, x)];
        }
      }
      result[at(row, column)] = sum;
    }
  }
  return result;
}

}  // namespace microtrace
