#pragma once
/// A hit as paths take it: enough to shade it, sooner than SurfaceInteraction.

#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <array>
#include <cstdint>

namespace microtrace {

/// World space. The same on every machine.
struct SurfacePoint {
  Vec3 p{0};                               ///< the point, rounded
  Vec3 n{0, 0, 1};                         ///< unit geometric normal of the front side
  Vec3 ns{0, 0, 1};                        ///< unit shading normal of the front side
  bool front = true;                       ///< whether the ray comes from the front side
  float distance = 0;                      ///< from the ray's origin
  const Mesh* mesh = nullptr;              ///< that it lies on; null: on a shape of its own
  std::array<std::uint32_t, 3> corners{};  ///< the triangle's vertices there
  Vec3 barycentrics{1, 0, 0};              ///< their weights
  Vec2 first_uv{0};    ///< texture coordinates of set 0; (0, 0) where the mesh lacks it
  float uv_scale = 0;  ///< sqrt(area in texture coordinates of set 0 / area in the world)

  /// Texture coordinates; (0, 0) where the mesh lacks the set.
  [[nodiscard]] Vec2 uv(std::uint32_t set) const { return set == 0 ? first_uv : further_uv(set); }
  /// The vertices' colours, white where they have none.
  [[nodiscard]] Vec4 color() const;
  /// The vertices' tangents, on the plane of ns, and the sign of the bitangent in w; zero if there
  /// are none.
  [[nodiscard]] Vec4 tangent() const;

 private:
  [[nodiscard]] Vec2 further_uv(std::uint32_t set) const;
};

/// `hit` is one of `ray`. `mesh` is null if the primitive is none of a mesh, else `triangle` is its
/// place there.
[[nodiscard]] SurfacePoint surface_point(const Primitives& primitives, const Ray& ray,
                                         const Hit& hit, const Mesh* mesh, std::size_t triangle);

/// The point of a mesh's triangle with those weights of its corners.
[[nodiscard]] SurfacePoint surface_point(const Mesh& mesh, std::size_t triangle,
                                         const Vec3& barycentrics, bool front);

}  // namespace microtrace
