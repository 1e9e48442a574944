#pragma once
/// Surface properties at a hit: position, normals and vertex attributes.

#include <microtrace/export.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace microtrace {

/// The position of a hit within its triangle.
struct TrianglePoint {
  /// Weights of a, b and c. None is negative, and their sum is 1 up to rounding.
  DVec3 barycentrics{1, 0, 0};
  PlacedMesh mesh{};                     ///< without arrays for a single triangle
  std::array<std::uint32_t, 3> corners;  ///< vertex indices into the mesh
};

/// The surface at a hit. Valid during the lifetime of the scene. The values are computed in float64
/// by + - * / and sqrt, so their bits are the same on every machine. The error of positions is
/// about 1e-15 times the magnitude of the coordinates, divided by the cosine of the angle to the
/// normal and, for long thin triangles, by the ratio of the width to the length; quadrics whose
/// coefficients cancel have greater errors.
/// Where a ray lies in the plane of a triangle, touches a surface or nearly does, they are computed
/// exactly and rounded once, like the side at which the ray arrives.
struct MICROTRACE_EXPORT SurfaceInteraction {
  DVec3 p{0};                 ///< position on the surface, not the ray's point at Hit::t
  DVec3 n{0, 0, 1};           ///< geometric normal of the front side, unit length
  DVec3 ns{0, 0, 1};          ///< shading normal of the front side, unit length; interpolated from
                              ///< the vertices' normals, or n if they have none
  bool front = true;          ///< true if the ray arrives at the front side
  std::size_t object = 0;     ///< index into Scene::objects; material_of() gives its material
  PrimitiveId primitive = 0;  ///< index within the object; 0 for shapes other than meshes
  std::optional<TrianglePoint> triangle{};  ///< set for triangles only

  /// Returns the texture coordinates of a set, or nothing if the surface lacks that set.
  [[nodiscard]] std::optional<DVec2> uv(std::size_t set) const;
  /// Returns the change of the texture coordinates when p moves by dp in the tangent plane; 0 if
  /// the surface lacks that set.
  [[nodiscard]] DVec2 uv_step(std::size_t set, const DVec3& dp) const;
  /// Returns the vertex color in linear Rec. 709 with alpha; white if the vertices have no colors.
  [[nodiscard]] DVec4 color() const;
};

/// Returns true if a ray of direction d arrives at the triangle's front side or is parallel to the
/// triangle's plane.
[[nodiscard]] MICROTRACE_EXPORT bool shows_front(const Triangle& triangle, const Vec3& d);

/// Returns the surface at `hit`, which must be a hit of `ray`, in the coordinates of the ray. A
/// triangle's front side is the side from which the vertices are counterclockwise. The front of a
/// sphere is its outside; the front of a plane or disc is the side of the normal; the front of a
/// quadric is the side where the polynomial is positive, so a double plane has two. Where the
/// surface has no normal (a triangle of zero area, a quadric's apex), the returned normal faces the
/// ray.
[[nodiscard]] MICROTRACE_EXPORT SurfaceInteraction interact(const Primitives& primitives,
                                                            const Ray& ray, const Hit& hit);

}  // namespace microtrace
