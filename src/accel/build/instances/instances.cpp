#include "accel/build/instances/instances.hpp"

#include "accel/build/binary/binary_tree.hpp"
#include "accel/build/instances/mesh_tree.hpp"

#include <microtrace/error.hpp>

#include <cstddef>
#include <memory>
#include <unordered_set>

namespace microtrace::build {
namespace {

/// Upper bound of the memory for an instance: itself, its reference and its id, two nodes of the
/// binary tree, and its part of a node of the finished tree.
constexpr std::uint64_t kBytesOfInstance = sizeof(Instance) + sizeof(Reference) +
                                           sizeof(PrimitiveId) + 2 * sizeof(BinaryNode) +
                                           sizeof(WideNode) / 2;

/// Returns the mesh that the objects of a run place, or null if they place none.
const Mesh* placed_mesh(const ObjectRun& run) {
  const PlacedMesh mesh = run.mesh(0);
  return mesh.placement != nullptr && !mesh.arrays->triangles.empty() ? mesh.arrays : nullptr;
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
    : primitives_(primitives), tree_(tree), is_instance_(primitives.scene().objects.size()) {
  const Objects& objects = primitives.scene().objects;
  std::size_t count = 0;
  for (const ObjectRun& run : objects.runs())
    if (placed_mesh(run) != nullptr) count += run.count;
  references_.reserve(count);
  for (const ObjectRun& run : objects.runs()) {
    const Mesh* const mesh = placed_mesh(run);
    if (mesh == nullptr) continue;
    const auto [known, is_new] =
        trees_.try_emplace(MeshKey(*mesh), static_cast<std::uint32_t>(tree.meshes.size()));
    if (is_new) tree.views.push_back(tree.meshes.emplace_back(tree_of(*mesh, options))->view);
    for (std::size_t i = 0; i < run.count; ++i) add(run, i, *tree.meshes[known->second]);
  }
  if (references_.size() > child_ref::kMaxInstances)
    throw Error(ErrorKind::limit, "", "the scene has more than 2^30 instances; leave some out");
}

void Instances::add(const ObjectRun& run, std::size_t i, const OwnedMeshTree& own) {
  const std::size_t object = run.begin + i;
  if (!own.tree.has_leaves()) {
    is_instance_[object] = true;  // has no triangles with finite vertices
    return;
  }
  const std::optional<Box> box = instance_box(own, run.mesh(i));
  if (!box) return;
  is_instance_[object] = true;
  references_.emplace_back(*box, static_cast<PrimitiveId>(object), kInstanceWeight);
}

Instance Instances::make(std::size_t object, const Box& box) const {
  const Objects& objects = primitives_.scene().objects;
  const ObjectRun run = objects.run(objects.run_of(object));
  const PlacedMesh mesh = run.mesh(object - run.begin);
  const std::uint32_t tree = trees_.at(MeshKey(*mesh.arrays));
  Instance instance = make_instance(tree_.meshes[tree]->tree, *mesh.placement, box);
  instance.mesh = tree & 0x7FFFFFFFU;  // there are fewer, as each has an instance
  instance.first_id = primitives_.first_id_of(object);
  return instance;
}

std::uint64_t memory_to_build(const Primitives& primitives) {
  std::uint64_t bytes = 0;
  std::unordered_set<MeshKey, MeshKey::Hash> known;
  for (const ObjectRun& run : primitives.scene().objects.runs()) {
    const Mesh* const mesh = placed_mesh(run);
    if (mesh == nullptr || known.insert(MeshKey(*mesh)).second)
      bytes += primitive_count(run.first->shape) * kBytesOfPrimitive;
    if (mesh != nullptr) bytes += run.count * kBytesOfInstance;
  }
  return bytes;
}

}  // namespace microtrace::build
