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

/// The translation to the origin for a scene within the bounds, if its distance is large compared
/// with its size; else zero. On each axis it is a multiple of a power of two above the size, so
/// that float32 coordinates no finer than their distance allows stay exact.
[[nodiscard]] DVec3 translation_to_origin(const PointBounds& bounds);

}  // namespace microtrace
