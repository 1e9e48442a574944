#pragma once
/// Decides intersections of triangles and planes by CGAL with exact number types, as a reference
/// for src/exact/.

#include "oracle/exact_numbers.hpp"

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

namespace microtrace::oracle {

/// Returns true if the ray is valid and meets the shape within its closed interval. Uses
/// do_intersect with the number type Mpzf.
[[nodiscard]] bool hits(const Triangle& triangle, const Ray& ray);
[[nodiscard]] bool hits(const Plane& plane, const Ray& ray);

/// Returns true if the triangle meets the closed box [lo, hi]. Uses do_intersect with the number
/// type Gmpq.
[[nodiscard]] bool meets_box(const Triangle& triangle, const Vec3& lo, const Vec3& hi);

/// Returns the parameter of the first hit, computed with the number type Gmpq. The ray must hit.
[[nodiscard]] Rational first_parameter(const Triangle& triangle, const Ray& ray);

}  // namespace microtrace::oracle
