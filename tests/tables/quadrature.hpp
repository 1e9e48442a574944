#pragma once
/// Gauss quadrature whose bits depend only on IEEE 754.

#include <vector>

namespace microtrace::tables {

/// Points and weights of a quadrature over [0, 1].
struct Quadrature {
  std::vector<double> at, weights;
};

/// Returns a quadrature that is exact for polynomials of degree 2 n - 1.
[[nodiscard]] Quadrature gauss_legendre(int n);

/// Returns a quadrature for functions that have square roots or change quickly near 0 and 1. It is
/// Gauss quadrature over v, where x = v^3 (10 - 15 v + 6 v^2).
[[nodiscard]] Quadrature graded(int n);

}  // namespace microtrace::tables
