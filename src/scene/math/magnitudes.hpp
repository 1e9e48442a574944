#pragma once
/// Bounds of the lengths of vectors.

#include <microtrace/math.hpp>

#include <cmath>

namespace microtrace {

/// Returns |x| + |y| + |z|, which is at least the length and is faster to compute.
[[nodiscard]] inline double sum_of_magnitudes(const DVec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

}  // namespace microtrace
