#pragma once
/// The point of a hit as shading of paths needs it. It is faster to compute than
/// SurfaceInteraction.

#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>
#include <microtrace/surface_interaction.hpp>

#include <array>
#include <cstdint>

namespace microtrace {

/// A point on a surface, in world space. Its bits are the same on every machine.
struct SurfacePoint {
  Vec3 p{0};                ///< the position, rounded
  Vec3 n{0, 0, 1};          ///< unit geometric normal of the front side
  Vec3 ns{0, 0, 1};         ///< unit shading normal of the front side
  bool front = true;        ///< true if the ray arrives at the front side
  float distance = 0;       ///< distance from the ray's origin
  PlacedMesh mesh{};        ///< without arrays if the primitive is not a mesh triangle
  bool is_edge_on = false;  ///< true for mesh triangles for which find_points() is not sure
  std::array<std::uint32_t, 3> corners{};  ///< vertex indices of the triangle
  Vec3 barycentrics{1, 0, 0};              ///< weights of the vertices
  Vec2 first_uv{0};          ///< texture coordinates of set 0; (0, 0) if the mesh has none
  float first_uv_scale = 0;  ///< uv_scale(0)

  /// Texture coordinates; (0, 0) if the mesh doesn't have this set.
  [[nodiscard]] Vec2 uv(std::uint32_t set) const { return set == 0 ? first_uv : further_uv(set); }
  /// sqrt(area in texture coordinates of this set / area in world space); 0 if the mesh doesn't
  /// have the set, or if the triangle is edge-on or has no area.
  [[nodiscard]] float uv_scale(std::uint32_t set) const {
    return set == 0 ? first_uv_scale : further_uv_scale(set);
  }
  /// Computes first_uv from the barycentrics.
  void find_first_uv() { first_uv = further_uv(0); }
  /// The interpolated vertex color; white if the mesh has no colors.
  [[nodiscard]] Vec4 color() const;
  /// The interpolated vertex tangent, projected onto the plane perpendicular to ns, with the
  /// bitangent's sign in w; zero if there are no tangents.
  [[nodiscard]] Vec4 tangent() const;

 private:
  [[nodiscard]] Vec2 further_uv(std::uint32_t set) const;
  [[nodiscard]] float further_uv_scale(std::uint32_t set) const;
};

/// The interpolated vertex color; white if there are none.
[[nodiscard]] Vec4 vertex_color(const PlacedMesh& mesh, const std::array<std::uint32_t, 3>& corners,
                                const Vec3& barycentrics);

/// The point on any shape, rounded from the result of interact().
[[nodiscard]] SurfacePoint rounded(const SurfaceInteraction& at, const Ray& ray, const Hit& hit);

/// The point of `hit`, which must be a hit of `ray`. `triangle` is the index of a mesh triangle in
/// `mesh`; for other primitives, `mesh` has no arrays.
[[nodiscard]] SurfacePoint surface_point(const Primitives& primitives, const Ray& ray,
                                         const Hit& hit, const PlacedMesh& mesh,
                                         std::size_t triangle);

/// The point on a mesh triangle that has these barycentric coordinates.
[[nodiscard]] SurfacePoint surface_point(const PlacedMesh& mesh, std::size_t triangle,
                                         const Vec3& barycentrics, bool front);
/// The front of such a point, with only what texture lookups without a footprint read. It is faster
/// to compute.
[[nodiscard]] SurfacePoint texture_point(const PlacedMesh& mesh, std::size_t triangle,
                                         const Vec3& barycentrics);

}  // namespace microtrace
