#pragma once
/// Least squares on grids, whose bits depend only on IEEE 754.

#include <cstddef>
#include <vector>

namespace microtrace::tables {

/// The factors Q R of a matrix with more rows than columns, given row by row.
class Factors {
 public:
  Factors(std::vector<double> matrix, std::size_t columns);

  [[nodiscard]] std::size_t rows() const { return q_.size() / columns_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }

  /// Q has orthonormal columns; R is triangular.
  [[nodiscard]] double q(std::size_t row, std::size_t column) const {
    return q_[row * columns_ + column];
  }
  /// Solves R x = y in place; `stride` is the distance between the numbers of y.
  void solve(double* y, std::size_t stride) const;

 private:
  std::size_t columns_;
  std::vector<double> q_, r_;
};

/// The coefficients x for which the product of the axes' matrices, applied to x, is nearest to the
/// targets in the least-squares sense. The axes of targets and coefficients are in the order of
/// `axes`; the last is contiguous.
[[nodiscard]] std::vector<double> fit(const std::vector<Factors>& axes,
                                      const std::vector<double>& targets);

/// The same, but the square of an error above a target counts 1 + penalty times.
[[nodiscard]] std::vector<double> low_fit(const std::vector<Factors>& axes,
                                          const std::vector<double>& targets, double penalty);

}  // namespace microtrace::tables
