#pragma once
/// The first hit of a ray with a shape, decided by arbitrary-width numbers: slow, scalar, and
/// always right. Filters decide nearly all hits; most other hits of triangles are decided by
/// triangle_hit.hpp without this code.

#include "exact/numbers/root.hpp"

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <optional>

namespace microtrace::exact {

/// True if the ray is valid (see Ray); invalid rays hit nothing.
[[nodiscard]] bool is_valid(const Ray& ray);

/// The least t in the closed [t_min, t_max] for which o + t d lies in the shape's closed point set;
/// nothing if there is none, or if the ray or the shape is invalid. A ray within a plane, a flat
/// shape or a quadric hits where it enters the shape.
[[nodiscard]] std::optional<Root> first_hit(const Sphere& sphere, const Ray& ray);
[[nodiscard]] std::optional<Root> first_hit(const Plane& plane, const Ray& ray);
[[nodiscard]] std::optional<Root> first_hit(const Disc& disc, const Ray& ray);
[[nodiscard]] std::optional<Root> first_hit(const Triangle& triangle, const Ray& ray);
[[nodiscard]] std::optional<Root> first_hit(const Quadric& quadric, const Ray& ray);

}  // namespace microtrace::exact
