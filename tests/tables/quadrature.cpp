#include "tables/quadrature.hpp"

#include "scene/math/trigonometry.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace microtrace::tables {
namespace {

struct Legendre {
  double value, derivative;
};

/// Returns the Legendre polynomial of degree n at x, for |x| < 1.
Legendre legendre(int n, double x) {
  double last = 1, value = x;
  for (int k = 2; k <= n; ++k) {
    const double next = ((2 * k - 1) * x * value - (k - 1) * last) / k;
    last = value;
    value = next;
  }
  return {.value = value, .derivative = n * (x * value - last) / (x * x - 1)};
}

}  // namespace

Quadrature gauss_legendre(int n) {
  Quadrature result;
  for (int i = 0; i < n; ++i) {
    double x = -cos_radians(std::numbers::pi * (i + 0.75) / (n + 0.5));
    for (int step = 0; step < 6; ++step) {  // Newton's method
      const Legendre p = legendre(n, x);
      x -= p.value / p.derivative;
    }
    const double slope = legendre(n, x).derivative;
    result.at.push_back(0.5 + 0.5 * x);
    result.weights.push_back(1 / ((1 - x * x) * slope * slope));
  }
  return result;
}

Quadrature graded(int n) {
  Quadrature result = gauss_legendre(n);
  for (std::size_t i = 0; i < result.at.size(); ++i) {
    double& x = result.at[i];
    result.weights[i] *= 30 * x * x * (1 - x) * (1 - x);
    x = x * x * x * (10 - x * (15 - 6 * x));
  }
  return result;
}

}  // namespace microtrace::tables
