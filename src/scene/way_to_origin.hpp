#pragma once
/// How far scenes are from the origin, where float32 has most points.

#include <microtrace/math.hpp>

#include <limits>

#include <glm/common.hpp>

namespace microtrace {

/// A box around points.
struct PointBounds {
  DVec3 low{std::numeric_limits<double>::infinity()};
  DVec3 high{-std::numeric_limits<double>::infinity()};

  void add(const DVec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

/// The way next to the origin for what lies within the bounds, if it is small beside its distance;
/// else zero. Along each axis it is a multiple of a power of two above the size, so that float32
/// which are as fine as their distance allows stay exact.
[[nodiscard]] DVec3 way_to_origin(const PointBounds& bounds);

}  // namespace microtrace
