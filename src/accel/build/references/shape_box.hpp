#pragma once
#include "accel/build/float4.hpp"

#include <microtrace/shape.hpp>

namespace microtrace::build {

/// True if the shape is empty by definition (see microtrace/shape.hpp).
[[nodiscard]] bool is_empty(const Triangle& triangle);
[[nodiscard]] bool is_empty(const Sphere& sphere);
[[nodiscard]] bool is_empty(const Disc& disc);
[[nodiscard]] bool is_empty(const Plane& plane);
[[nodiscard]] bool is_empty(const Quadric& quadric);

/// Returns a box that contains every point of a nonempty shape. The box is exact for a triangle and
/// rounded outwards by at most two units in the last place for a sphere or a disc. Coordinates
/// beyond the range of float32 are infinite.
[[nodiscard]] Box box_of(const Triangle& triangle);
[[nodiscard]] Box box_of(const Sphere& sphere);
[[nodiscard]] Box box_of(const Disc& disc);

/// Returns a box that contains a point whose coordinates have errors of at most 2^-50 times `size`.
[[nodiscard]] Box around(const DVec3& point, const DVec3& size);

[[nodiscard]] bool is_finite(const Box& box);

}  // namespace microtrace::build
