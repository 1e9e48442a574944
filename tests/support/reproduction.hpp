#pragma once
/// Output of failing exactness tests for reproducing the case.

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <string>
#include <variant>

namespace microtrace::adversarial {

/// The shapes for which src/exact/ finds first hits.
using FirstHitShape = std::variant<Sphere, Plane, Disc, Triangle, Quadric>;

/// The ray's numbers in hexadecimal, and a scene whose only pixel looks along the ray at the shape.
[[nodiscard]] std::string reproduction(const Ray& ray, const FirstHitShape& shape);

}  // namespace microtrace::adversarial
