#pragma once
/// A hit as needed for shading paths; faster than SurfaceInteraction.

#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>
#include <microtrace/surface_interaction.hpp>

#include <array>
#include <cstdint>

namespace microtrace {

/// In world space. The same bits on every machine.
struct SurfacePoint {
  Vec3 p{0};                               ///< the point, rounded
  Vec3 n{0, 0, 1};                         ///< unit geometric normal of the front side
  Vec3 ns{0, 0, 1};                        ///< unit shading normal of the front side
  bool front = true;                       ///< whether the ray arrives at the front side
  float distance = 0;                      ///< from the ray's origin
  const Mesh* mesh = nullptr;              ///< null: the primitive is not a mesh triangle
  std::array<std::uint32_t, 3> corners{};  ///< vertex indices of the triangle
  Vec3 barycentrics{1, 0, 0};              ///< weights of the vertices
  Vec2 first_uv{0};    ///< texture coordinates of set 0; (0, 0) if the mesh has none
  float uv_scale = 0;  ///< sqrt(area in texture coordinates of set 0 / area in the world)

  /// Texture coordinates; (0, 0) if the mesh doesn't have this set.
  [[nodiscard]] Vec2 uv(std::uint32_t set) const { return set == 0 ? first_uv : further_uv(set); }
  /// The interpolated vertex color; white if there is none.
  [[nodiscard]] Vec4 color() const;
  /// The interpolated vertex tangent, projected on the plane of ns, with the sign of the bitangent
  /// in w; zero if there is none.
  [[nodiscard]] Vec4 tangent() const;

 private:
  [[nodiscard]] Vec2 further_uv(std::uint32_t set) const;
};

/// The point of any shape, rounded from the result of interact().
[[nodiscard]] SurfacePoint rounded(const SurfaceInteraction& at, const Ray& ray, const Hit& hit);

/// `hit` must be a hit of `ray`. `mesh` is null if the primitive is not a mesh triangle, else
/// `triangle` is its index in the mesh.
[[nodiscard]] SurfacePoint surface_point(const Primitives& primitives, const Ray& ray,
                                         const Hit& hit, const Mesh* mesh, std::size_t triangle);

/// The point of a mesh triangle with these barycentric coordinates.
[[nodiscard]] SurfacePoint surface_point(const Mesh& mesh, std::size_t triangle,
                                         const Vec3& barycentrics, bool front);

}  // namespace microtrace
