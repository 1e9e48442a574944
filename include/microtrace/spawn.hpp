#pragma once
/// Where a ray that leaves a surface begins: without an epsilon, and never on the wrong side.

#include <microtrace/export.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <optional>

namespace microtrace {

/// The origin of a ray that goes on into `direction` (any length but zero) from the point at which
/// `ray` hits `surface`. The surface's function F is zero on it: n.(x - a) for flat ones,
/// |x - c|^2 - r^2 for a sphere, a quadric's own polynomial. The side of departure is the sign that
/// F takes just behind the exact hit point in this direction; where the direction stays in the
/// surface, the side from which the ray came. Over the real numbers, however grazing the direction,
/// however far from (0, 0, 0), however large, small or thin the surface:
///
/// 1. Side. The origin lies strictly on the side of departure.
/// 2. No hit of its own. The new ray meets the whole surface F = 0 at t >= 0 as often as one that
/// starts just behind the exact point: a flat surface never again; a sphere never if it departs
/// outside, once if inside. So t_min = 0 will do.
/// 3. What lies behind stays behind. Nothing that is on a flat surface's plane or beyond it is hit:
/// no coplanar neighbour, and none across a convex edge.
/// 4. Near. Each coordinate is the exact one rounded to the nearest float32; then one of them is
/// moved further, by at most 4 representable numbers for a flat surface, at most 64 for a curved
/// one. No coordinate is -0.
///
/// Not promised: that the origin is on the right side of other surfaces as near to the hit point as
/// those few roundings. In a concave crease it may have left the room by the other wall;
/// Bvh::spawn_origin minds them.
///
/// Nothing if the ray does not hit the surface, if the direction is zero or not finite, for a
/// triangle without area, or if there is no such float32 point (beyond the largest number, or
/// within a sphere not much larger than the spacing of numbers).
[[nodiscard]] MICROTRACE_EXPORT std::optional<Vec3> spawn_origin(const Triangle& surface,
                                                                 const Ray& ray,
                                                                 const Vec3& direction);
[[nodiscard]] MICROTRACE_EXPORT std::optional<Vec3> spawn_origin(const Plane& surface,
                                                                 const Ray& ray,
                                                                 const Vec3& direction);
[[nodiscard]] MICROTRACE_EXPORT std::optional<Vec3> spawn_origin(const Disc& surface,
                                                                 const Ray& ray,
                                                                 const Vec3& direction);
[[nodiscard]] MICROTRACE_EXPORT std::optional<Vec3> spawn_origin(const Sphere& surface,
                                                                 const Ray& ray,
                                                                 const Vec3& direction);
[[nodiscard]] MICROTRACE_EXPORT std::optional<Vec3> spawn_origin(const Quadric& surface,
                                                                 const Ray& ray,
                                                                 const Vec3& direction);

/// The same for a primitive that the ray has hit.
[[nodiscard]] MICROTRACE_EXPORT std::optional<Vec3> spawn_origin(const Primitives& primitives,
                                                                 PrimitiveId id, const Ray& ray,
                                                                 const Vec3& direction);

}  // namespace microtrace
