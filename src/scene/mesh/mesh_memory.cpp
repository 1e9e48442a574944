#include "scene/mesh/mesh_memory.hpp"

#include <variant>

namespace microtrace {

std::uint64_t memory_of(const Mesh& mesh) {
  // Each segment becomes two triangles with four new vertices.
  const std::uint64_t segments = mesh.segments.size();
  const std::uint64_t triangles = mesh.triangles.size() + 2 * segments;
  std::uint64_t of_vertex = sizeof(Vec3);
  if (!mesh.normals.empty()) of_vertex += sizeof(Vec3);
  if (!mesh.tangents.empty()) of_vertex += sizeof(Vec4);
  if (!mesh.colors.empty()) of_vertex += sizeof(Vec4);
  for (const auto& set : mesh.uv_sets) of_vertex += set.empty() ? 0 : sizeof(Vec2);
  return triangles * sizeof(mesh.triangles[0]) + segments * sizeof(mesh.segments[0]) +
         (mesh.positions.size() + 4 * segments) * of_vertex;
}

namespace {

/// Returns the size of a scene's objects and of the arrays of the meshes for which counts(mesh) is
/// true.
template <class Counts>
std::uint64_t memory_of_objects(const Scene& scene, const Counts& counts) {
  std::uint64_t result = scene.objects.size() * sizeof(Object);
  for (const ObjectRun& run : scene.objects.runs()) {
    const PlacedMesh mesh = run.mesh(0);
    if (mesh && counts(*mesh.arrays)) result += run.count * memory_of(*mesh.arrays);
  }
  return result;
}

}  // namespace

std::uint64_t memory_of(const Scene& scene, PlacedMeshes placed) {
  return memory_of_objects(scene, [placed](const Mesh& mesh) {
    return !mesh.placement || placed == PlacedMeshes::copied;
  });
}

std::uint64_t memory_to_widen(const Scene& scene) {
  return memory_of_objects(scene, [](const Mesh& mesh) { return !mesh.segments.empty(); });
}

}  // namespace microtrace
