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
  /// Weights of a, b and c: none negative, their sum 1 up to rounding.
  DVec3 barycentrics{1, 0, 0};
  const Mesh* mesh = nullptr;            ///< the triangle's mesh; null for a single triangle
  std::array<std::uint32_t, 3> corners;  ///< vertex indices into the mesh
};

/// Valid during the lifetime of the scene. Computed in float64 by + - * / and sqrt from the scene's
/// numbers, so the bits are the same on every machine. The relative error is about 1e-15 of the
/// coordinates' magnitude unless the shape is seen edge on.
struct MICROTRACE_EXPORT SurfaceInteraction {
  DVec3 p{0};                 ///< position, on the surface rather than at Hit::t on the ray
  DVec3 n{0, 0, 1};           ///< geometric normal of the front side, unit length
  DVec3 ns{0, 0, 1};          ///< shading normal of the front side, unit length: interpolated from
                              ///< the vertices; n where they have none
  bool front = true;          ///< true if the ray arrives at the front side
  std::size_t object = 0;     ///< index into Scene::objects; material_of() gives its material
  PrimitiveId primitive = 0;  ///< index within the object: the triangle of a mesh, else 0
  std::optional<TrianglePoint> triangle{};  ///< for triangles

  /// Texture coordinates; nothing if the surface lacks that set.
  [[nodiscard]] std::optional<DVec2> uv(std::size_t set) const;
  /// Change of the texture coordinates when p moves by dp in the tangent plane; 0 without them.
  [[nodiscard]] DVec2 uv_step(std::size_t set, const DVec3& dp) const;
  /// Vertex color, linear Rec. 709 with alpha; white if the vertices have none.
  [[nodiscard]] DVec4 color() const;
};

/// True if a ray of direction d arrives at the triangle's front side, or is parallel to it.
[[nodiscard]] MICROTRACE_EXPORT bool shows_front(const Triangle& triangle, const Vec3& d);

/// The surface at `hit`, one of the hits of `ray`, in the coordinates of the ray. The front side of
/// a triangle is the one with counterclockwise vertices; of a sphere the outside; of a plane and a
/// disc the side of the normal; of a quadric the side with positive polynomial. If the surface has
/// no normal (a triangle without area, a quadric's apex), the normal faces the ray.
[[nodiscard]] MICROTRACE_EXPORT SurfaceInteraction interact(const Primitives& primitives,
                                                            const Ray& ray, const Hit& hit);

}  // namespace microtrace
