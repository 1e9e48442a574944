#pragma once
/// Prints the input of a failed exactness test, from which the failure can be reproduced.

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <string>
#include <variant>

namespace microtrace::adversarial {

/// Shapes whose first hit src/exact computes.
using FirstHitShape = std::variant<Sphere, Plane, Disc, Triangle, Quadric>;

/// Returns the ray's numbers in hexadecimal, and a scene whose only pixel looks along the ray at
/// the shape.
[[nodiscard]] std::string reproduction(const Ray& ray, const FirstHitShape& shape);

}  // namespace microtrace::adversarial
