#include "accel/build/instances/instances.hpp"

#include "accel/build/binary/binary_tree.hpp"
#include "accel/build/instances/mesh_tree.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <unordered_set>
#include <variant>

namespace microtrace::build {
namespace {

/// Upper bound of the memory for an instance: itself, its reference and its id, two nodes of the
/// binary tree, and its part of a node of the finished tree.
constexpr std::uint64_t kBytesOfInstance = sizeof(Instance) + sizeof(Reference) +
                                           sizeof(PrimitiveId) + 2 * sizeof(BinaryNode) +
                                           sizeof(WideNode) / 2;

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

Instances::Instances(const Primitives& primitives, const BuildOptions& options, Tree& tree)
    : primitives_(primitives), is_instance_(primitives.scene().objects.size()) {
  const std::vector<Object>& objects = primitives.scene().objects;
  references_.reserve(static_cast<std::size_t>(std::ranges::count_if(
      objects, [](const Object& object) { return placed_mesh(object) != nullptr; })));
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Mesh* const mesh = placed_mesh(objects[i]);
    if (mesh == nullptr) continue;
    const OwnedMeshTree*& own = trees_[MeshKey(*mesh)];
    if (own == nullptr) own = tree.meshes.emplace_back(tree_of(*mesh, options)).get();
    if (!own->tree.has_leaves()) {
      is_instance_[i] = true;  // has no triangles with finite vertices
      continue;
    }
    const std::optional<Box> box = instance_box(*own, *mesh);
    if (!box) continue;
    is_instance_[i] = true;
    references_.emplace_back(*box, static_cast<PrimitiveId>(i), kInstanceWeight);
  }
  if (references_.size() > child_ref::kMaxInstances)
    throw Error(ErrorKind::limit, "", "the scene has more than 2^30 instances; leave some out");
}

Instance Instances::make(std::size_t object, const Box& box) const {
  const Mesh& mesh = *placed_mesh(primitives_.scene().objects[object]);
  return make_instance(*trees_.at(MeshKey(mesh)), mesh, primitives_.first_id_of(object), box);
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
