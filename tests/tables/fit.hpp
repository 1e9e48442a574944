#pragma once
/// Least-squares fits on grids. Their bits depend only on IEEE 754.

#include <cstddef>
#include <vector>

namespace microtrace::tables {

/// The factors Q and R of a matrix that is given row by row. It must have more rows than columns.
class Factors {
 public:
  Factors(std::vector<double> matrix, std::size_t columns);

  [[nodiscard]] std::size_t rows() const { return q_.size() / columns_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }

  /// Returns an element of Q, whose columns are orthonormal. R is triangular.
  [[nodiscard]] double q(std::size_t row, std::size_t column) const {
    return q_[row * columns_ + column];
  }
  /// Solves R x = y in place. `stride` is the distance between neighboring elements of y.
  void solve(double* y, std::size_t stride) const;

 private:
  std::size_t columns_;
  std::vector<double> q_, r_;
};

/// Returns the coefficients x that solve a least-squares problem on a grid: the product of the
/// axes' matrices, applied to x, approximates the targets. The axes of targets and coefficients are
/// in the order of `axes`, and the last axis is contiguous.
[[nodiscard]] std::vector<double> fit(const std::vector<Factors>& axes,
                                      const std::vector<double>& targets);

/// Like fit(), but the square of an error above a target is weighted by 1 + penalty.
[[nodiscard]] std::vector<double> low_fit(const std::vector<Factors>& axes,
                                          const std::vector<double>& targets, double penalty);

}  // namespace microtrace::tables
