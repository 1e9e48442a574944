#pragma once
#include "accel/build/float4.hpp"

#include <microtrace/shape.hpp>

namespace microtrace::build {

/// Whether the shape is empty by definition.
[[nodiscard]] bool is_empty(const Triangle& triangle);
[[nodiscard]] bool is_empty(const Sphere& sphere);
[[nodiscard]] bool is_empty(const Disc& disc);
[[nodiscard]] bool is_empty(const Plane& plane);
[[nodiscard]] bool is_empty(const Quadric& quadric);

/// A box that contains every point of a nonempty shape: exact for a triangle, rounded outwards by
/// at most two units in the last place for a sphere or a disc. Infinite if it exceeds the range of
/// float32.
[[nodiscard]] Box box_of(const Triangle& triangle);
[[nodiscard]] Box box_of(const Sphere& sphere);
[[nodiscard]] Box box_of(const Disc& disc);

/// A box around a point with an error of at most 2^-50 times `size`, an upper bound of the
/// coordinates.
[[nodiscard]] Box around(const DVec3& point, const DVec3& size);

[[nodiscard]] bool is_finite(const Box& box);

}  // namespace microtrace::build
