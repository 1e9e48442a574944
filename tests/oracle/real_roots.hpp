#pragma once
/// Computes first hits on planes, discs, spheres and quadrics by CGAL's rationals and their
/// square-root extensions. Deliberately independent of src/exact/: polynomials are derived from
/// values of the shape's equation, and roots come from CGAL::make_root_of_2.

#include "exact/numbers/root.hpp"
#include "oracle/exact_numbers.hpp"

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <optional>

#include <CGAL/Sqrt_extension.h>

namespace microtrace::oracle {

/// A number a + b sqrt(c). Numbers with different c can be compared.
using Real = CGAL::Sqrt_extension<Rational, Rational, CGAL::Tag_true, CGAL::Tag_true>;

[[nodiscard]] std::optional<Real> first_parameter(const Plane& plane, const Ray& ray);
[[nodiscard]] std::optional<Real> first_parameter(const Disc& disc, const Ray& ray);
[[nodiscard]] std::optional<Real> first_parameter(const Sphere& sphere, const Ray& ray);
[[nodiscard]] std::optional<Real> first_parameter(const Quadric& quadric, const Ray& ray);

[[nodiscard]] Real to_real(const exact::Root& t);

}  // namespace microtrace::oracle
