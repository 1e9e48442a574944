#pragma once
/// A hit in full: position, orientation of the surface, and interpolated attributes.

#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace microtrace {

/// A hit's position within a triangle.
struct TrianglePoint {
  /// Barycentric coordinates of a, b and c: nonnegative, with sum 1 except for rounding.
  DVec3 barycentrics{1, 0, 0};
  const Mesh* mesh = nullptr;            ///< the triangle's mesh; null for a single triangle
  std::array<std::uint32_t, 3> corners;  ///< its vertex indices in the mesh
};

/// World space. Computed in float64 with + - * / and sqrt from the stored scene, so it is the same
/// on every machine. The relative error is about 1e-15 unless the shape is seen edge-on.
struct SurfaceInteraction {
  DVec3 p{0};         ///< the point on the surface, which is more precise than Hit::t on the ray
  DVec3 n{0, 0, 1};   ///< unit geometric normal of the front side
  DVec3 ns{0, 0, 1};  ///< unit shading normal of the front side: interpolated from the vertices; n
                      ///< if they have none
  bool front = true;  ///< whether the ray arrives at the front side
  std::optional<TrianglePoint> triangle{};  ///< for hits of triangles

  /// Texture coordinates; nothing if the surface doesn't have this set.
  [[nodiscard]] std::optional<DVec2> uv(std::size_t set) const;
  /// The change of the texture coordinates for a step dp in the surface's plane; 0 if there are
  /// none.
  [[nodiscard]] DVec2 uv_step(std::size_t set, const DVec3& dp) const;
  /// The interpolated vertex color, linear Rec. 709 with alpha; white if there is none.
  [[nodiscard]] DVec4 color() const;
};

/// Whether a ray with direction d arrives at the front of the triangle, or parallel to it.
[[nodiscard]] bool shows_front(const Triangle& triangle, const Vec3& d);

/// Computes the interaction at `hit`, which must be a hit of `ray`. The front of a triangle is the
/// side from which its vertices are counterclockwise; of a sphere the outside; of a plane and a
/// disc the side of the normal; of a quadric the side where the polynomial increases. If a surface
/// has no normal (a triangle without area, a quadric's apex), the normal faces the ray.
[[nodiscard]] SurfaceInteraction interact(const Primitives& primitives, const Ray& ray,
                                          const Hit& hit);

}  // namespace microtrace
