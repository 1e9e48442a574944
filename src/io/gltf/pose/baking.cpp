#include "io/gltf/pose/baking.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace microtrace::io::gltf {
namespace {

/// Returns v scaled to unit length, or zero if v is zero or not finite.
DVec3 direction_of(const DVec3& v) {
  const double greatest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(greatest > 0) || !std::isfinite(greatest)) return DVec3(0);
  const DVec3 scaled = v / greatest;  // prevents overflow and underflow of the squares
  return scaled / std::sqrt(glm::dot(scaled, scaled));
}

/// Returns a positive multiple of the inverse transpose of m, which exists even for singular
/// matrices.
glm::dmat3 normal_matrix(const glm::dmat3& m, bool mirrored) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                             glm::cross(m[0], m[1]));
  return mirrored ? -cofactors : cofactors;
}

/// The transforms of one vertex and of its normal.
struct VertexTransform {
  explicit VertexTransform(const DMat4& m)
      : world_from_mesh(m),
        mirrored(glm::determinant(glm::dmat3(m)) < 0),
        normals(normal_matrix(glm::dmat3(m), mirrored)) {}

  DMat4 world_from_mesh;
  bool mirrored;
  glm::dmat3 normals;
};

/// Returns the morphed vector if there is one, otherwise the vector in the mesh.
template <typename Own>
DVec3 vector_of(const Array<Own>& own, const std::vector<DVec3>& morphed, std::size_t i) {
  return morphed.empty() ? DVec3(own[i]) : morphed[i];
}

/// Bakes a mesh. transform_of(i) must return the VertexTransform of vertex i.
template <typename TransformOf>
Mesh baked_by(const Mesh& mesh, const Morphed& morphed, const TransformOf& transform_of) {
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
  std::vector<bool> mirrored(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const VertexTransform& transform = transform_of(i);
    const glm::dvec4 position(vector_of(mesh.positions, morphed.positions, i), 1);
    result.positions.emplace_back(transform.world_from_mesh * position);
    mirrored[i] = transform.mirrored;
    if (!mesh.normals.empty()) {
      const DVec3 normal = vector_of(mesh.normals, morphed.normals, i);
      result.normals.emplace_back(direction_of(transform.normals * normal));
    }
    if (!mesh.tangents.empty()) {
      const DVec3 tangent = vector_of(mesh.tangents, morphed.tangents, i);
      const float handedness = mesh.tangents[i].w;
      result.tangents.emplace_back(
          Vec3(direction_of(glm::dmat3(transform.world_from_mesh) * tangent)),
          transform.mirrored ? -handedness : handedness);
    }
  }
  if (std::ranges::find(mirrored, true) == mirrored.end()) return result;
  for (auto& corners : result.triangles.edit()) {
    if (mirrored[corners[0]]) std::swap(corners[1], corners[2]);
  }
  return result;
}

}  // namespace

Mesh baked(const Mesh& mesh, const Morphed& morphed, const DMat4& world_from_mesh) {
  const VertexTransform transform(world_from_mesh);
  return baked_by(mesh, morphed, [&](std::size_t) -> const VertexTransform& { return transform; });
}

Mesh baked(const Mesh& mesh, const Morphed& morphed, const JointBlend& blend) {
  return baked_by(mesh, morphed, [&](std::size_t vertex) {
    return VertexTransform(blend.world_from_mesh(vertex));
  });
}

}  // namespace microtrace::io::gltf
