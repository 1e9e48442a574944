#pragma once
#include "accel/build/float4.hpp"

#include <microtrace/shape.hpp>

namespace microtrace::build {

/// True if the shape is empty by definition (see microtrace/shape.hpp).
[[nodiscard]] inline bool is_empty(const Triangle& t) {
  // A sum of zeros is NaN if a factor is not finite.
  const Vec3 zero = t.a * 0.0F + t.b * 0.0F + t.c * 0.0F;
  return !(zero.x + zero.y + zero.z == 0);
}
[[nodiscard]] bool is_empty(const Sphere& sphere);
[[nodiscard]] bool is_empty(const Disc& disc);
[[nodiscard]] bool is_empty(const Plane& plane);
[[nodiscard]] bool is_empty(const Quadric& quadric);

/// Returns a vertex as a vector. -0 becomes 0, so that the order of vertices has no effect on
/// boxes.
[[nodiscard]] inline Float4 lanes(const Vec3& v) {
  return Float4{v.x, v.y, v.z, 0} + splat(0);
}

/// Returns a box that contains every point of a nonempty shape. The box is exact for a triangle and
/// rounded outwards by at most two units in the last place for a sphere or a disc. Coordinates
/// beyond the range of float32 are infinite.
[[nodiscard]] inline Box box_of(const Triangle& t) {
  Box box;
  for (const Vec3& vertex : {t.a, t.b, t.c}) box.include(lanes(vertex));
  return box;
}
[[nodiscard]] Box box_of(const Sphere& sphere);
[[nodiscard]] Box box_of(const Disc& disc);
/// Infinite unless the quadric is an ellipsoid that is well enough conditioned for float64.
[[nodiscard]] Box box_of(const Quadric& quadric);

/// Returns a box that contains a point whose coordinates have errors of at most 2^-50 times `size`.
[[nodiscard]] Box around(const DVec3& point, const DVec3& size);

[[nodiscard]] bool is_finite(const Box& box);

}  // namespace microtrace::build
