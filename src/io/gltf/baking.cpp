#include "io/gltf/baking.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace microtrace::io::gltf {
namespace {

/// Of unit length; zero where v is zero or not finite.
DVec3 direction_of(const DVec3& v) {
  const double greatest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(greatest > 0) || !std::isfinite(greatest)) return DVec3(0);
  const DVec3 scaled = v / greatest;  // whose square neither overflows nor vanishes
  return scaled / std::sqrt(glm::dot(scaled, scaled));
}

/// The inverse transpose but for a positive factor. It exists for matrices without inverse too.
glm::dmat3 normal_matrix(const glm::dmat3& m, bool mirrored) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                             glm::cross(m[0], m[1]));
  return mirrored ? -cofactors : cofactors;
}

}  // namespace

Mesh baked(const Mesh& mesh, const DMat4& world_from_mesh) {
  const glm::dmat3 linear(world_from_mesh);
  const bool mirrored = glm::determinant(linear) < 0;
  Mesh result;
  result.uv_sets = mesh.uv_sets;
  result.colors = mesh.colors;
  result.positions.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) {
    result.positions.emplace_back(world_from_mesh * glm::dvec4(p, 1));
  }
  result.triangles = mesh.triangles;
  result.segments = mesh.segments;
  if (mirrored) {
    for (auto& corners : result.triangles) std::swap(corners[1], corners[2]);
  }
  result.normals.reserve(mesh.normals.size());
  const glm::dmat3 normals = normal_matrix(linear, mirrored);
  for (const Vec3& n : mesh.normals) result.normals.emplace_back(direction_of(normals * DVec3(n)));
  result.tangents.reserve(mesh.tangents.size());
  for (const Vec4& t : mesh.tangents) {
    const DVec3 direction = direction_of(linear * DVec3(t));
    result.tangents.emplace_back(Vec3(direction), mirrored ? -t.w : t.w);
  }
  return result;
}

}  // namespace microtrace::io::gltf
