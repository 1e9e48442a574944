#pragma once
#include "scene/math/exponential.hpp"

#include <microtrace/math.hpp>

#include <algorithm>

namespace microtrace {

/// The transmittance of a medium over a distance, by the Beer-Lambert law. `extinction` is in
/// powers of two per length.
[[nodiscard]] inline Vec3 beer_lambert(const Vec3& extinction, float distance) {
  Vec3 left(1);
  for (int c = 0; c < 3; ++c) {
    const double powers = double{extinction[c]} * distance;
    if (powers > 0) left[c] = static_cast<float>(power_of_two(-std::min(powers, 200.0)));
  }
  return left;
}

}  // namespace microtrace
