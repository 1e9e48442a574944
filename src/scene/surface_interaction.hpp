#pragma once
/// A hit in full: where it is, how the surface lies there, what its vertices say.

#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace microtrace {

/// Where a hit lies in a triangle.
struct TrianglePoint {
  /// Weights of a, b and c: none negative, their sum 1 but for rounding.
  DVec3 barycentrics{1, 0, 0};
  const Mesh* mesh = nullptr;            ///< that the triangle is one of; null: it stands alone
  std::array<std::uint32_t, 3> corners;  ///< its vertices there
};

/// World space. Computed in float64 by + - * / and sqrt alone from what the scene stores, so it is
/// the same on every machine, and true to about 1e-15 of the coordinates' size where the shape is
/// not seen edge on.
struct SurfaceInteraction {
  DVec3 p{0};         ///< the point, on the surface rather than at Hit::t on the ray
  DVec3 n{0, 0, 1};   ///< unit geometric normal of the front side
  DVec3 ns{0, 0, 1};  ///< unit shading normal of the front side: the vertices' interpolated; n
                      ///< where these have none
  bool front = true;  ///< whether the ray comes from the front side
  std::optional<TrianglePoint> triangle{};  ///< of hits of triangles

  /// Texture coordinates; nothing where the surface lacks that set.
  [[nodiscard]] std::optional<DVec2> uv(std::size_t set) const;
  /// How they change where the point moves by dp in the surface's plane; 0 where they are lacking.
  [[nodiscard]] DVec2 uv_step(std::size_t set, const DVec3& dp) const;
  /// The vertices' colours, linear Rec. 709 with alpha; white where they have none.
  [[nodiscard]] DVec4 color() const;
};

/// Whether a ray of direction d comes from the front of the triangle, or along it.
[[nodiscard]] bool shows_front(const Triangle& triangle, const Vec3& d);

/// The front of a triangle is where its corners go anticlockwise; of a sphere the outside; of a
/// plane and a disc where the normal points; of a quadric where the polynomial grows. Where a
/// surface has no normal (a triangle without area, a quadric's apex) the one that faces the ray is
/// taken. `hit` is one of `ray`.
[[nodiscard]] SurfaceInteraction interact(const Primitives& primitives, const Ray& ray,
                                          const Hit& hit);

}  // namespace microtrace
