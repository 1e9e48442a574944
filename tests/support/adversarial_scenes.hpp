#pragma once
/// Scenes and rays made to defeat a tree and its kernels: shared corners, duplicates, coplanar
/// walls, slivers, huge beside tiny, far from the origin, beyond what kernels take, not finite.

#include "support/adversarial_rays.hpp"

#include <microtrace/scene.hpp>

#include <array>
#include <vector>

namespace microtrace::adversarial {

using Corners = std::array<Vec3, 3>;

/// Triangles that share no corners, each from make_corners().
[[nodiscard]] Mesh mesh_of(int triangles, auto&& make_corners) {
  Mesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& corner : Corners(make_corners())) mesh.positions.push_back(corner);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// One or more meshes of up to 400 triangles, and often some other shapes.
[[nodiscard]] Scene random_scene(Random& random);

/// A point from which rays are likely to meet such a scene, often one of its surfaces.
[[nodiscard]] Vec3 origin(Random& random, const Scene& scene);

/// A ray from o, often at a corner or at a point of an edge; some have a short range, directions
/// along axes, or of a size that kernels don't take.
[[nodiscard]] Ray random_ray(Random& random, const Scene& scene, const Vec3& o);

/// Rays without a common origin; among them some that are not valid, too large for the
/// kernels, or share an origin with their neighbours.
[[nodiscard]] std::vector<Ray> unrelated_rays(Random& random, const Scene& scene, int count);

}  // namespace microtrace::adversarial
