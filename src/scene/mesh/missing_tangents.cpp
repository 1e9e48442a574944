#include "scene/mesh/missing_tangents.hpp"

#include "base/finite.hpp"
#include "scene/mesh/shared_meshes.hpp"
#include "scene/mesh/tangents.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

namespace microtrace {
namespace {

/// Returns false if the texture's image was left out when the scene was loaded, because it has no
/// effect on the quantities that are wanted.
bool is_loaded(const Scene& scene, const TextureUse& use) {
  const std::optional<std::uint32_t> image = scene.textures[use.texture].image;
  return image && scene.images[*image] != nullptr;
}

bool are_finite(const auto& vectors) {
  return std::ranges::all_of(vectors, [](const auto& v) { return is_finite(v); });
}

bool is_finite_mesh(const Mesh& mesh, std::size_t uv_set) {
  return are_finite(mesh.positions) && are_finite(mesh.normals) && are_finite(mesh.uv_sets[uv_set]);
}

/// Returns missing_tangents() of an object, if its tangents affect what was loaded.
std::optional<std::uint32_t> missing_set(const Scene& scene, const Object& object) {
  const auto* mesh = std::get_if<Mesh>(&object.shape);
  if (mesh == nullptr) return std::nullopt;
  const Material& material = material_of(scene, object);
  const bool is_mapped = material.normal_texture && is_loaded(scene, *material.normal_texture);
  const bool is_coat_mapped = material.clearcoat && material.clearcoat->normal_texture &&
                              is_loaded(scene, *material.clearcoat->normal_texture);
  if (!is_mapped && !is_coat_mapped && !material.anisotropy) return std::nullopt;
  return missing_tangents(material, *mesh);
}

/// Returns true if an object's tangents are missing and can be generated.
bool lacks_tangents(const Scene& scene) {
  for (const ObjectRun& run : scene.objects.runs()) {
    const std::optional<std::uint32_t> set = missing_set(scene, *run.first);
    if (set && is_finite_mesh(std::get<Mesh>(run.first->shape), *set)) return true;
  }
  return false;
}

/// Identifies all arrays of a mesh, which objects may share.
std::vector<ArrayKey> keys_of_arrays(const Mesh& mesh) {
  std::vector<ArrayKey> keys{ArrayKey(mesh.positions), ArrayKey(mesh.triangles),
                             ArrayKey(mesh.normals), ArrayKey(mesh.colors),
                             ArrayKey(mesh.segments)};
  for (const auto& set : mesh.uv_sets) keys.emplace_back(set);
  return keys;
}

}  // namespace

std::shared_ptr<const Scene> with_tangents(std::shared_ptr<const Scene> scene) {
  if (!lacks_tangents(*scene)) return scene;
  auto result = std::make_shared<Scene>(*scene);
  std::map<std::pair<std::uint32_t, std::vector<ArrayKey>>, Mesh> made;
  result->objects.edit_runs([&](Object& object) {
    const std::optional<std::uint32_t> set = missing_set(*scene, object);
    if (!set) return;
    auto& mesh = std::get<Mesh>(object.shape);
    const auto [known, is_new] = made.try_emplace({*set, keys_of_arrays(mesh)}, mesh);
    if (is_new && is_finite_mesh(mesh, *set)) make_tangents(known->second, *set);
    const std::shared_ptr<const Placement> placement = mesh.placement;
    mesh = known->second;
    mesh.placement = placement;
  });
  return result;
}

}  // namespace microtrace
