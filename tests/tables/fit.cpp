#include "tables/fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace microtrace::tables {
namespace {

/// Replaces the axis of size `from` by one of size `to`. result(..., j, ...) is the sum over i of
/// weight(i, j) value(..., i, ...).
template <typename Weight>
std::vector<double> contracted(const std::vector<double>& values, std::size_t from, std::size_t to,
                               std::size_t inner, const Weight& weight) {
  const std::size_t outer = values.size() / (from * inner);
  std::vector<double> result(outer * to * inner);
  for (std::size_t o = 0; o < outer; ++o) {
    for (std::size_t j = 0; j < to; ++j) {
      double* out = &result[(o * to + j) * inner];
      for (std::size_t i = 0; i < from; ++i) {
        const double w = weight(i, j);
        if (w == 0) continue;
        const double* in = &values[(o * from + i) * inner];
        for (std::size_t k = 0; k < inner; ++k) out[k] += w * in[k];
      }
    }
  }
  return result;
}

/// Multiplies all axes by Q^T (to_q) or by Q (from_q).
std::vector<double> to_q(const std::vector<Factors>& axes, std::vector<double> values) {
  std::size_t inner = 1;
  for (std::size_t a = axes.size(); a-- > 0;) {
    values = contracted(values, axes[a].rows(), axes[a].columns(), inner,
                        [&](std::size_t i, std::size_t j) { return axes[a].q(i, j); });
    inner *= axes[a].columns();
  }
  return values;
}

std::vector<double> from_q(const std::vector<Factors>& axes, std::vector<double> values) {
  std::size_t inner = 1;
  for (std::size_t a = axes.size(); a-- > 0;) {
    values = contracted(values, axes[a].columns(), axes[a].rows(), inner,
                        [&](std::size_t i, std::size_t j) { return axes[a].q(j, i); });
    inner *= axes[a].rows();
  }
  return values;
}

}  // namespace

// Modified Gram-Schmidt, applied twice for orthogonality.
Factors::Factors(std::vector<double> matrix, std::size_t columns)
    : columns_(columns), q_(std::move(matrix)), r_(columns * columns) {
  const std::size_t n = rows();
  for (std::size_t j = 0; j < columns; ++j) {
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t k = 0; k < j; ++k) {
        double dot = 0;
        for (std::size_t i = 0; i < n; ++i) dot += q(i, k) * q(i, j);
        for (std::size_t i = 0; i < n; ++i) q_[i * columns + j] -= dot * q(i, k);
        r_[k * columns + j] += dot;
      }
    }
    double square = 0;
    for (std::size_t i = 0; i < n; ++i) square += q(i, j) * q(i, j);
    const double length = std::sqrt(square);
    r_[j * columns + j] = length;
    for (std::size_t i = 0; i < n; ++i) q_[i * columns + j] /= length;
  }
}

void Factors::solve(double* y, std::size_t stride) const {
  for (std::size_t i = columns_; i-- > 0;) {
    double sum = y[i * stride];
    for (std::size_t k = i + 1; k < columns_; ++k) sum -= r_[i * columns_ + k] * y[k * stride];
    y[i * stride] = sum / r_[i * columns_ + i];
  }
}

std::vector<double> fit(const std::vector<Factors>& axes, const std::vector<double>& targets) {
  std::vector<double> result = to_q(axes, targets);
  std::size_t inner = 1;
  for (std::size_t a = axes.size(); a-- > 0;) {
    const std::size_t n = axes[a].columns(), block = n * inner;
    for (std::size_t o = 0; o < result.size(); o += block)
      for (std::size_t k = 0; k < inner; ++k) axes[a].solve(&result[o + k], inner);
    inner = block;
  }
  return result;
}

// Uses Uzawa's method: gradient ascent in the Lagrange multipliers of the upper bounds.
std::vector<double> low_fit(const std::vector<Factors>& axes, const std::vector<double>& targets,
                            double penalty) {
  constexpr int rounds = 400;
  const double step = 1.5 / (1 + 1 / penalty);
  std::vector<double> multipliers(targets.size()), lowered = targets;
  for (int round = 0; round < rounds; ++round) {
    const std::vector<double> fitted = from_q(axes, to_q(axes, lowered));
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const double excess = fitted[i] - targets[i];
      multipliers[i] = std::max(multipliers[i] + step * (excess - multipliers[i] / penalty), 0.0);
      lowered[i] = targets[i] - multipliers[i];
    }
  }
  return fit(axes, lowered);
}

}  // namespace microtrace::tables
