#include "accel/build/instances/instances.hpp"

#include "accel/build/instances/mesh_tree.hpp"
#include "scene/mesh/shared_meshes.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <variant>

namespace microtrace::build {
namespace {

/// Upper bound of the memory for an instance: itself, its box, two references, two nodes of the
/// binary tree, and its part of a node of the finished tree.
constexpr std::uint64_t kBytesOfInstance = sizeof(Instance) + 32 + 64 + 128 + sizeof(WideNode) / 2;

const Mesh* placed_mesh(const Object& object) {
  const auto* mesh = std::get_if<Mesh>(&object.shape);
  return mesh != nullptr && mesh->placement && !mesh->triangles.empty() ? mesh : nullptr;
}

std::shared_ptr<const OwnedMeshTree> tree_of(const Mesh& mesh, const BuildOptions& options) {
  if (options.previous) {
    for (const auto& known : options.previous->meshes)
      if (known->is_of(mesh)) return known;
  }
  return std::make_shared<const OwnedMeshTree>(mesh, options);
}

}  // namespace

std::vector<bool> find_instances(const Primitives& primitives, const BuildOptions& options,
                                 Tree& tree, std::vector<Box>& boxes) {
  const std::vector<Object>& objects = primitives.scene().objects;
  std::vector<bool> is_instance(objects.size());
  std::unordered_map<MeshKey, const OwnedMeshTree*, MeshKey::Hash> trees;
  const auto placed = static_cast<std::size_t>(std::ranges::count_if(
      objects, [](const Object& object) { return placed_mesh(object) != nullptr; }));
  tree.instances.reserve(placed);
  boxes.reserve(placed);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Mesh* const mesh = placed_mesh(objects[i]);
    if (mesh == nullptr) continue;
    const OwnedMeshTree*& own = trees[MeshKey(*mesh)];
    if (own == nullptr) own = tree.meshes.emplace_back(tree_of(*mesh, options)).get();
    if (!own->tree.has_leaves()) {
      is_instance[i] = true;  // has no triangles with finite vertices
      continue;
    }
    const auto made = make_instance(*own, *mesh, primitives.first_id_of(i));
    if (!made) continue;
    is_instance[i] = true;
    tree.instances.push_back(made->instance);
    boxes.push_back(made->box);
  }
  if (tree.instances.size() > child_ref::kMaxInstances)
    throw Error(ErrorKind::limit, "", "the scene has more than 2^30 instances; leave some out");
  return is_instance;
}

std::uint64_t memory_to_build(const Primitives& primitives) {
  std::uint64_t bytes = 0;
  std::unordered_set<MeshKey, MeshKey::Hash> known;
  for (const Object& object : primitives.scene().objects) {
    const Mesh* const mesh = placed_mesh(object);
    if (mesh == nullptr || known.insert(MeshKey(*mesh)).second)
      bytes += primitive_count(object.shape) * kBytesOfPrimitive;
    if (mesh != nullptr) bytes += kBytesOfInstance;
  }
  return bytes;
}

}  // namespace microtrace::build
