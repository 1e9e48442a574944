#pragma once
/// Tests of shapes against all rays of a frustum. A test may always answer that it does not know.

#include "accel/frustum/directions.hpp"

#include <microtrace/shape.hpp>

#include <limits>

namespace microtrace {

/// What rays with a common origin have in common as to one shape.
struct Meeting {
  enum class Kind { none, all, unknown };
  Kind kind = Kind::unknown;
  /// Bounds of t for directions that are not scaled to unit length. Only the lower one is valid if
  /// the kind is unknown.
  Interval t{.lo = 0, .hi = std::numeric_limits<double>::infinity()};
};

[[nodiscard]] Meeting meeting(const Directions& directions, const Vec3& o, const Plane& plane);
[[nodiscard]] Meeting meeting(const Directions& directions, const Vec3& o, const Sphere& sphere);
[[nodiscard]] Meeting meeting(const Directions& directions, const Vec3& o, const Disc& disc);
[[nodiscard]] Meeting meeting(const Directions& directions, const Vec3& o,
                              const Triangle& triangle);
[[nodiscard]] Meeting meeting(const Directions& directions, const Vec3& o, const Quadric& quadric);

}  // namespace microtrace
