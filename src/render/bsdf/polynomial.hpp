#pragma once
#include <array>
#include <cstddef>

namespace microtrace::bsdf {

/// Coefficients in ascending powers; rows are powers of the first variable.
template <std::size_t rows, std::size_t columns>
using Polynomial2 = std::array<std::array<float, columns>, rows>;

/// Horner's scheme.
template <std::size_t rows, std::size_t columns>
[[nodiscard]] float value(const Polynomial2<rows, columns>& p, float x, float y) {
  std::array<float, columns> sum = p[rows - 1];
  for (std::size_t k = rows - 1; k-- > 0;)
    for (std::size_t i = 0; i < columns; ++i) sum[i] = sum[i] * x + p[k][i];
  float result = sum[columns - 1];
  for (std::size_t i = columns - 1; i-- > 0;) result = result * y + sum[i];
  return result;
}

/// Inserts the first two of four variables; returns the polynomial of the other two.
template <std::size_t n, typename Plane>
[[nodiscard]] Plane plane_at(const std::array<std::array<Plane, n>, n>& planes, float x, float y) {
  Plane sum{};
  float row_power = 1;
  for (const auto& row : planes) {
    float power = row_power;
    for (const Plane& plane : row) {
      for (std::size_t i = 0; i < plane.size(); ++i)
        for (std::size_t k = 0; k < plane[i].size(); ++k) sum[i][k] += power * plane[i][k];
      power *= y;
    }
    row_power *= x;
  }
  return sum;
}

}  // namespace microtrace::bsdf
