#include "scene/mesh/missing_tangents.hpp"

#include "base/finite.hpp"
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

/// Returns the set of texture coordinates from which the object's missing tangents are generated.
std::optional<std::uint32_t> missing_set(const Scene& scene, const Object& object) {
  const Material& material = material_of(scene, object);
  const std::optional<std::uint32_t> set = tangent_set(material);
  const auto* mesh = std::get_if<Mesh>(&object.shape);
  if (!set || mesh == nullptr) return std::nullopt;
  if (!mesh->tangents.empty() || mesh->triangles.empty()) return std::nullopt;
  if (*set >= mesh->uv_sets.size() || mesh->uv_sets[*set].empty()) return std::nullopt;
  const bool is_mapped = material.normal_texture && is_loaded(scene, *material.normal_texture);
  const bool is_coat_mapped = material.clearcoat && material.clearcoat->normal_texture &&
                              is_loaded(scene, *material.clearcoat->normal_texture);
  if (!is_mapped && !is_coat_mapped && !material.anisotropy) return std::nullopt;
  const bool is_computable =
      are_finite(mesh->positions) && are_finite(mesh->normals) && are_finite(mesh->uv_sets[*set]);
  return is_computable ? set : std::nullopt;
}

/// Returns true if an object's tangents are missing.
bool lacks_tangents(const Scene& scene) {
  for (const ObjectRun& run : scene.objects.runs()) {
    if (missing_set(scene, *run.first)) return true;
  }
  return false;
}

/// The addresses and sizes of a mesh's arrays, which objects may share.
std::vector<std::pair<const void*, std::size_t>> spans_of_arrays(const Mesh& mesh) {
  std::vector<std::pair<const void*, std::size_t>> result;
  const auto add = [&](const auto& array) { result.emplace_back(array.data(), array.size()); };
  add(mesh.positions);
  add(mesh.triangles);
  add(mesh.normals);
  add(mesh.colors);
  add(mesh.segments);
  for (const auto& set : mesh.uv_sets) add(set);
  return result;
}

}  // namespace

std::shared_ptr<const Scene> with_tangents(std::shared_ptr<const Scene> scene) {
  if (!lacks_tangents(*scene)) return scene;
  auto result = std::make_shared<Scene>(*scene);
  std::map<std::pair<std::uint32_t, decltype(spans_of_arrays({}))>, Mesh> made;
  result->objects.edit_runs([&](Object& object) {
    const std::optional<std::uint32_t> set = missing_set(*scene, object);
    if (!set) return;
    auto& mesh = std::get<Mesh>(object.shape);
    const auto [known, is_new] = made.try_emplace({*set, spans_of_arrays(mesh)}, mesh);
    if (is_new) make_tangents(known->second, *set);
    const std::shared_ptr<const Placement> placement = mesh.placement;
    mesh = known->second;
    mesh.placement = placement;
  });
  return result;
}

}  // namespace microtrace
