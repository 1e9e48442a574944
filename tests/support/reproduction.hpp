#pragma once
/// What a failing exactness test prints, so that anyone can repeat the case.

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <string>
#include <variant>

namespace microtrace::adversarial {

/// The shapes of which src/exact/ finds the first hit.
using FirstHitShape = std::variant<Sphere, Plane, Disc, Triangle, Quadric>;

/// The ray's numbers in hexadecimal, and a scene whose only pixel looks along the ray at the shape.
[[nodiscard]] std::string reproduction(const Ray& ray, const FirstHitShape& shape);

}  // namespace microtrace::adversarial
