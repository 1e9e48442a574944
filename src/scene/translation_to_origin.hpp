#pragma once
/// Translation of distant scenes to the origin, where float32 is most precise.

#include <microtrace/math.hpp>

#include <array>
#include <limits>

#include <glm/common.hpp>

namespace microtrace {

/// A bounding box of points.
struct PointBounds {
  DVec3 low{std::numeric_limits<double>::infinity()};
  DVec3 high{-std::numeric_limits<double>::infinity()};

  void add(const DVec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

[[nodiscard]] inline std::array<DVec3, 8> corners_of(const PointBounds& box) {
  std::array<DVec3, 8> corners;
  for (unsigned i = 0; i < 8; ++i) {
    for (int k = 0; k < 3; ++k)
      corners[i][k] = (i >> static_cast<unsigned>(k) & 1U) != 0 ? box.high[k] : box.low[k];
  }
  return corners;
}

/// The translation that moves a scene with these bounds to the origin if the scene's distance is
/// large compared with its size; otherwise zero. On each axis, the translation is a multiple of a
/// power of two that exceeds the size. Coordinates that float32 could represent before the
/// translation therefore remain exact. A scene of a single position is moved to the origin.
[[nodiscard]] DVec3 translation_to_origin(const PointBounds& bounds);

}  // namespace microtrace
