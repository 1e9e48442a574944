#pragma once
/// Computes the first hit of a ray with a shape by arbitrary-width numbers. This is slow, but
/// always exact. Filters decide nearly all hits without this code, and triangle_hit.hpp decides
/// most of the remaining hits of triangles.

#include "exact/numbers/root.hpp"

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <optional>

namespace microtrace::exact {

/// Returns true if the ray is valid (see Ray). Invalid rays hit nothing.
[[nodiscard]] bool is_valid(const Ray& ray);

/// Returns true if the shape has no points: a number is not finite, the radius is negative or the
/// normal is zero.
[[nodiscard]] bool is_empty(const Sphere& sphere);
[[nodiscard]] bool is_empty(const Plane& plane);
[[nodiscard]] bool is_empty(const Disc& disc);
[[nodiscard]] bool is_empty(const Triangle& triangle);
[[nodiscard]] bool is_empty(const Quadric& quadric);

/// Returns the least t in the closed interval [t_min, t_max] for which o + t d lies in the shape's
/// closed point set. Returns nothing if there is none, if the ray is invalid, or if the shape is
/// empty. A ray that lies within a flat shape or a quadric hits at the first point of the shape in
/// its interval.
[[nodiscard]] std::optional<Root> first_hit(const Sphere& sphere, const Ray& ray);
[[nodiscard]] std::optional<Root> first_hit(const Plane& plane, const Ray& ray);
[[nodiscard]] std::optional<Root> first_hit(const Disc& disc, const Ray& ray);
[[nodiscard]] std::optional<Root> first_hit(const Triangle& triangle, const Ray& ray);
[[nodiscard]] std::optional<Root> first_hit(const Quadric& quadric, const Ray& ray);

}  // namespace microtrace::exact
