#pragma once
/// Origins of rays that leave a surface: without an epsilon, and never on the wrong side.

#include <microtrace/export.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <optional>

namespace microtrace {

/// The origin of a ray that leaves the hit of `ray` on `surface` in `direction` (any nonzero
/// length). The surface's function F is zero on it: n.(x - a) for flat surfaces, |x - c|^2 - r^2
/// for a sphere, a quadric's polynomial. The outgoing side is the sign of F just beyond the exact
/// hit point in this direction; if the direction is within the surface, the side of the incoming
/// ray. Over the real numbers, for any grazing angle, any distance from (0, 0, 0), and any size of
/// the surface:
///
/// 1. Side. The origin is strictly on the outgoing side.
/// 2. No spurious hit. The new ray hits the whole surface F = 0 at t >= 0 as often as a ray that
///   starts just beyond the exact point: a flat surface never; a sphere never if it leaves
///   outwards, once if inwards. t_min = 0 is therefore sufficient.
/// 3. Nothing behind a flat surface is hit: nothing on its plane or beyond it, such as coplanar
///   neighbors and the other faces of a convex edge.
/// 4. Distance. Each coordinate is the exact one rounded to the nearest float32; then one of them
///   is moved by at most 4 float32 steps for a flat surface, at most 64 for a curved one. No
///   coordinate is -0.
///
/// Not guaranteed: that the origin is on the right side of other surfaces within a few roundings of
/// the hit point. In a concave crease it may be beyond the other wall; Bvh::spawn_origin takes
/// other surfaces into account.
///
/// Nothing if the ray does not hit the surface, if the direction is zero or not finite, for a
/// triangle without area, or if there is no such float32 point (beyond the largest number, or
/// inside a sphere not much larger than the spacing of float32 numbers).
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

/// The same for a primitive that the ray hits.
[[nodiscard]] MICROTRACE_EXPORT std::optional<Vec3> spawn_origin(const Primitives& primitives,
                                                                 PrimitiveId id, const Ray& ray,
                                                                 const Vec3& direction);

}  // namespace microtrace
