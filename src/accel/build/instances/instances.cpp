#include "accel/build/instances/instances.hpp"

#include "accel/build/instances/mesh_tree.hpp"
#include "scene/mesh/shared_meshes.hpp"

#include <microtrace/error.hpp>

#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <variant>

namespace microtrace::build {
namespace {

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
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Mesh* const mesh = placed_mesh(objects[i]);
    if (mesh == nullptr) continue;
    const OwnedMeshTree*& own = trees[MeshKey(*mesh)];
    if (own == nullptr) own = tree.meshes.emplace_back(tree_of(*mesh, options)).get();
    if (!own->tree.has_leaves()) {
      is_instance[i] = true;  // has no triangles with finite vertices
      continue;
    }
    const auto placed = make_instance(*own, *mesh, primitives.first_id_of(i));
    if (!placed) continue;
    is_instance[i] = true;
    tree.instances.push_back(placed->instance);
    boxes.push_back(placed->box);
  }
  if (tree.instances.size() > child_ref::kMaxInstances)
    throw Error(ErrorKind::limit, "", "the scene has more than 2^30 instances; leave some out");
  return is_instance;
}

std::uint64_t stored_primitives(const Primitives& primitives) {
  std::uint64_t count = 0;
  std::unordered_set<MeshKey, MeshKey::Hash> known;
  for (const Object& object : primitives.scene().objects) {
    const Mesh* const mesh = placed_mesh(object);
    if (mesh == nullptr || known.insert(MeshKey(*mesh)).second)
      count += primitive_count(object.shape);
    else
      ++count;
  }
  return count;
}

}  // namespace microtrace::build
