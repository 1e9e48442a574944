#include "io/gltf/pose/baking.hpp"

#include <microtrace/placement.hpp>

#include <utility>

namespace microtrace::io::gltf {
namespace {

/// Returns the morphed vector if there is one, otherwise the vector in the mesh.
template <typename Own>
DVec3 vector_of(const Array<Own>& own, const std::vector<DVec3>& morphed, std::size_t i) {
  return morphed.empty() ? DVec3(own[i]) : morphed[i];
}

/// Bakes a mesh. placement_of(i) must return the Placement of vertex i. If `is_mirrored` is true,
/// the file's triangles are clockwise where the mesh is placed.
template <typename PlacementOf>
Mesh baked_by(const Mesh& mesh, const Morphed& morphed, bool is_mirrored,
              const PlacementOf& placement_of) {
  Mesh result;
  result.uv_sets = morphed.uv_sets.empty() ? mesh.uv_sets : morphed.uv_sets;
  if (morphed.colors.empty())
    result.colors = mesh.colors;
  else
    result.colors = morphed.colors;
  result.triangles = mesh.triangles;
  result.segments = mesh.segments;
  result.positions.reserve(mesh.positions.size());
  result.normals.reserve(mesh.normals.size());
  result.tangents.reserve(mesh.tangents.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Placement& placement = placement_of(i);
    result.positions.emplace_back(placement.point(vector_of(mesh.positions, morphed.positions, i)));
    if (!mesh.normals.empty()) {
      const DVec3 normal = vector_of(mesh.normals, morphed.normals, i);
      result.normals.emplace_back(placement.normal(normal));
    }
    if (!mesh.tangents.empty()) {
      const DVec3 tangent = vector_of(mesh.tangents, morphed.tangents, i);
      // Rigs that are mirrored as a whole mirror the vertices twice, but tangents have the
      // handedness before that.
      const bool is_turned = is_mirrored || placement.is_mirrored();
      const float handedness = mesh.tangents[i].w;
      result.tangents.emplace_back(Vec3(placement.direction(tangent)),
                                   is_turned ? -handedness : handedness);
    }
  }
  if (is_mirrored) {
    for (auto& corners : result.triangles.edit()) std::swap(corners[1], corners[2]);
  }
  return result;
}

}  // namespace

Mesh baked(const Mesh& mesh, const Morphed& morphed, const DMat4& world_from_mesh) {
  const Placement placement(world_from_mesh);
  return baked_by(mesh, morphed, placement.is_mirrored(),
                  [&](std::size_t) -> const Placement& { return placement; });
}

Mesh baked(const Mesh& mesh, const Morphed& morphed, const JointBlend& blend,
           const DMat4& world_from_node) {
  return baked_by(mesh, morphed, Placement(world_from_node).is_mirrored(),
                  [&](std::size_t vertex) { return Placement(blend.world_from_mesh(vertex)); });
}

}  // namespace microtrace::io::gltf
