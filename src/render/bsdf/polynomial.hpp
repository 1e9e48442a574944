#pragma once
#include "simd/vectors.hpp"

#include <array>
#include <cstddef>

namespace microtrace::bsdf {

/// The coefficients of a polynomial in two variables. p[i][j] is the coefficient of x^i y^j.
template <std::size_t rows, std::size_t columns>
using Polynomial2 = std::array<std::array<float, columns>, rows>;

/// Evaluates a Polynomial2 by Horner's scheme. Coefficients are numbers or lanes.
template <int N, int rows, int columns, class Coefficient>
[[nodiscard]] Float<N> value(const Coefficient* p, const Float<N>& x, const Float<N>& y) {
  Float<N> result{};
  for (int i = columns - 1; i >= 0; --i) {
    Float<N> sum = Float<N>{} + p[(rows - 1) * columns + i];
    for (int k = rows - 2; k >= 0; --k) sum = sum * x + p[k * columns + i];
    result = i == columns - 1 ? sum : result * y + sum;
  }
  return result;
}

/// Substitutes x and y for the first two of a polynomial's four variables. `planes` contains, for
/// each of n x n powers of these two, a Polynomial2 with `size` coefficients in the other two. Sets
/// `sum` to the resulting coefficients in the other two variables.
template <int N, int n, int size>
void insert(const float* planes, const Float<N>& x, const Float<N>& y, Float<N> (&sum)[size]) {
  for (Float<N>& coefficient : sum) coefficient = Float<N>{};
  Float<N> row_power = Float<N>{} + 1;
  for (int row = 0; row < n; ++row) {
    Float<N> power = row_power;
    for (int column = 0; column < n; ++column, planes += size) {
      for (int i = 0; i < size; ++i) sum[i] += power * planes[i];
      power *= y;
    }
    row_power *= x;
  }
}

}  // namespace microtrace::bsdf
