#pragma once
/// Scenes and rays that are difficult for a tree and its kernels: shared vertices, duplicates,
/// coplanar walls, slivers, huge triangles beside tiny ones, and scenes far from the origin. Some
/// numbers exceed the kernels' limits or are not finite.

#include "support/cases/adversarial_rays.hpp"

#include <microtrace/scene.hpp>

#include <array>
#include <vector>

namespace microtrace::adversarial {

using Corners = std::array<Vec3, 3>;

/// Returns a mesh of triangles made by make_corners(), without shared vertices.
[[nodiscard]] Mesh mesh_of(int triangles, auto&& make_corners) {
  Mesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& corner : Corners(make_corners())) mesh.positions.push_back(corner);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

enum class SceneKind {
  soup,     ///< small triangles anywhere
  lattice,  ///< integer coordinates: shared vertices, coplanar walls, duplicates, triangles without
            ///< area
  huge_and_tiny,  ///< sizes from 2^-20 to 2^6
  far_from_zero,  ///< 2^20 triangle sizes away from (0, 0, 0)
  slivers,        ///< heights down to 2^-26 of the length
  walls,          ///< in planes x, y or z = an integer; rays along edges and within planes
  degenerate,     ///< points and segments, some repeated, among small triangles
  any_size,       ///< sizes from 2^-140 to 2^60, beyond the kernels' limits; some not finite
};

inline constexpr std::array kSceneKinds = {
    SceneKind::soup,    SceneKind::lattice, SceneKind::huge_and_tiny, SceneKind::far_from_zero,
    SceneKind::slivers, SceneKind::walls,   SceneKind::degenerate,    SceneKind::any_size};

[[nodiscard]] const char* name(SceneKind kind);

/// Returns a scene with a mesh of up to 400 triangles and often a second mesh, which may be a copy
/// of the first. Other shapes may be added.
[[nodiscard]] Scene random_scene(Random& random, SceneKind kind);
/// Returns a random scene of a random kind.
[[nodiscard]] Scene random_scene(Random& random);

/// Returns a random point from which rays are likely to hit the scene. It is often on a surface.
[[nodiscard]] Vec3 origin(Random& random, const Scene& scene);

/// Returns a ray from o, often toward a vertex or a point of an edge. Some rays have a short
/// interval, an axis-aligned direction, or a length beyond the kernels' limits.
[[nodiscard]] Ray random_ray(Random& random, const Scene& scene, const Vec3& o);

/// Rays without a common origin. Some are invalid, exceed the kernels' limits, or share an origin
/// with their neighbors.
[[nodiscard]] std::vector<Ray> unrelated_rays(Random& random, const Scene& scene, int count);

}  // namespace microtrace::adversarial
