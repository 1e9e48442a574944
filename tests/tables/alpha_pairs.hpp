#pragma once
/// Points at which the albedos of anisotropic microfacets are integrated.

#include "scene/math/trigonometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace microtrace::tables {

using Points = std::vector<double>;

/// Returns n points in [0, 1] that are denser at the ends.
inline Points chebyshev(std::size_t n) {
  Points result;
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = std::numbers::pi * static_cast<double>(i) / static_cast<double>(n - 1);
    result.push_back(0.5 - 0.5 * cos_radians(turn));
  }
  return result;
}

/// Returns the centers of n equal parts of [0, 1].
inline Points middles(std::size_t n) {
  Points result;
  for (std::size_t i = 0; i < n; ++i)
    result.push_back((static_cast<double>(i) + 0.5) / static_cast<double>(n));
  return result;
}

/// The square roots of the smaller and of the larger alpha.
struct Pair {
  double smaller, greater;

  [[nodiscard]] double alpha_x() const { return greater * greater; }
  [[nodiscard]] double alpha_y() const { return smaller * smaller; }
};

/// Returns the pairs that KHR_materials_anisotropy defines for these roughnesses and strengths.
inline std::vector<Pair> pairs(const Points& roughnesses, const Points& strengths) {
  constexpr double least = 0.0316227766016837933;  // square root of the smallest alpha
  std::vector<Pair> result;
  for (const double roughness : roughnesses) {
    const double smaller = std::max(roughness, least), alpha = smaller * smaller;
    for (const double strength : strengths)
      result.push_back(
          {.smaller = smaller, .greater = std::sqrt(alpha + (1 - alpha) * strength * strength)});
  }
  return result;
}

}  // namespace microtrace::tables
