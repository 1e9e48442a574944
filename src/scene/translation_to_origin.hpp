#pragma once
/// Translation of distant scenes to the origin, where float32 is most precise.

#include <microtrace/math.hpp>

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

/// The translation that moves a scene with these bounds to the origin if the scene's distance is
/// large compared with its size; otherwise zero. On each axis, the translation is a multiple of a
/// power of two that exceeds the size. Coordinates that float32 could represent before the
/// translation therefore remain exact.
[[nodiscard]] DVec3 translation_to_origin(const PointBounds& bounds);

}  // namespace microtrace
