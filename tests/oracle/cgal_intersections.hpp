#pragma once
/// Intersections of triangles and planes decided by CGAL with exact number types: the reference for
/// src/exact/.

#include "oracle/exact_numbers.hpp"

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

namespace microtrace::oracle {

/// True if the ray is valid and meets the shape within its closed interval, by do_intersect over
/// Mpzf.
[[nodiscard]] bool hits(const Triangle& triangle, const Ray& ray);
[[nodiscard]] bool hits(const Plane& plane, const Ray& ray);

/// The parameter of the first hit, over Gmpq; the ray must hit.
[[nodiscard]] Rational first_parameter(const Triangle& triangle, const Ray& ray);

}  // namespace microtrace::oracle
