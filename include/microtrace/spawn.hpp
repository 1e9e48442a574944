#pragma once
/// Computes the origins of rays that leave a surface. No epsilon is needed, and no origin is on the
/// wrong side of the surface.

#include <microtrace/export.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <optional>

namespace microtrace {

/// Returns the origin of a new ray that leaves the hit of `ray` on `surface` in `direction` (any
/// nonzero length).
///
/// Let F be the surface's implicit function: n.(x - a) for flat surfaces, |x - c|^2 - r^2 for a
/// sphere, the polynomial for a quadric. The outgoing side is the sign of F just beyond the exact
/// hit point in this direction. If the direction lies within the surface, the outgoing side is the
/// side from which `ray` arrives. The following holds in real arithmetic for any grazing angle, any
/// distance from (0, 0, 0), and any size of the surface:
///
/// 1. Side. The origin is strictly on the outgoing side.
/// 2. No spurious hit. The new ray hits the whole surface F = 0 at t >= 0 as often as a ray that
///    starts just beyond the exact hit point. It never hits a flat surface; it hits a sphere once
///    if it leaves inwards, and never if it leaves outwards. The new ray may therefore have t_min =
///    0.
/// 3. No hit behind a flat surface. The new ray hits nothing on the surface's plane or beyond it,
///    such as coplanar neighbors and the other faces of a convex edge.
/// 4. Distance. The exact hit point is rounded to the nearest float32 values. Then one coordinate
///    is moved by at most 4 float32 steps for a flat surface, or 64 for a curved one. No coordinate
///    is -0.
///
/// The origin may be on the wrong side of other surfaces that are within a few float32 steps of the
/// hit point. In a concave crease it may be beyond the other wall. Bvh::spawn_origin takes other
/// surfaces into account.
///
/// Returns nothing if the ray does not hit the surface, if the direction is zero or not finite, if
/// the surface is a triangle of zero area, or if no such float32 point exists. The last case occurs
/// beyond the largest float32 number, and inside spheres not much larger than the spacing of
/// float32 numbers.
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

/// Does the same for a primitive that the ray hits.
[[nodiscard]] MICROTRACE_EXPORT std::optional<Vec3> spawn_origin(const Primitives& primitives,
                                                                 PrimitiveId id, const Ray& ray,
                                                                 const Vec3& direction);

}  // namespace microtrace
