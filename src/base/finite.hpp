#pragma once
#include <microtrace/math.hpp>

#include <cmath>

namespace microtrace {

/// Returns true if no component is infinite or NaN.
template <glm::length_t n, class Number>
[[nodiscard]] bool is_finite(const glm::vec<n, Number>& v) {
  for (glm::length_t i = 0; i < n; ++i)
    if (!std::isfinite(v[i])) return false;
  return true;
}

}  // namespace microtrace
