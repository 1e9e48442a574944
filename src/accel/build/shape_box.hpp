#pragma once
#include "accel/build/float4.hpp"

#include <microtrace/shape.hpp>

namespace microtrace::build {

/// Whether the shape has no points by its definition.
[[nodiscard]] bool is_empty(const Triangle& triangle);
[[nodiscard]] bool is_empty(const Sphere& sphere);
[[nodiscard]] bool is_empty(const Disc& disc);
[[nodiscard]] bool is_empty(const Plane& plane);
[[nodiscard]] bool is_empty(const Quadric& quadric);

/// A box that holds every point of a shape that is not empty: exactly that of a triangle, rounded
/// outward by at most two units in the last place of a sphere or a disc. Infinite if it leaves the
/// range of float32.
[[nodiscard]] Box box_of(const Triangle& triangle);
[[nodiscard]] Box box_of(const Sphere& sphere);
[[nodiscard]] Box box_of(const Disc& disc);

/// A box that holds a point known within 2^-50 of `size`, which is no less than its coordinates.
[[nodiscard]] Box around(const DVec3& point, const DVec3& size);

[[nodiscard]] bool is_finite(const Box& box);

}  // namespace microtrace::build
