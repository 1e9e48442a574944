#pragma once
#include "accel/build/float4.hpp"
#include "accel/build/references/reference.hpp"
#include "accel/build/tree.hpp"
#include "scene/mesh/shared_meshes.hpp"

#include <microtrace/page_allocator.hpp>
#include <microtrace/primitives.hpp>

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace microtrace::build {

/// The instances of a scene. They are made when the tree over them is written, so that a build
/// needs no memory for them before.
class Instances {
 public:
  /// Finds the instances, and adds trees of their meshes to `tree`. Takes these from
  /// options.previous if it has them. The arguments must outlive this object.
  Instances(const Primitives& primitives, const BuildOptions& options, Tree& tree);

  /// For each object, whether it is an instance. Placed meshes without an instance_box() are not,
  /// so their triangles belong in the tree like those of other objects.
  [[nodiscard]] const std::vector<bool>& is_instance() const { return is_instance_; }

  /// References to all instances. Their ids are the indices of the objects. Can be taken once.
  [[nodiscard]] PageVector<Reference> take_references() { return std::move(references_); }

  /// Returns the instance of the object with this index, whose reference has this box.
  [[nodiscard]] Instance make(std::size_t object, const Box& box) const;

 private:
  /// Adds the object with index run.begin + i, whose mesh has this tree, if it is an instance.
  void add(const ObjectRun& run, std::size_t i, const OwnedMeshTree& own);

  using Trees = std::unordered_map<MeshKey, std::uint32_t, MeshKey::Hash>;

  const Primitives& primitives_;
  const Tree& tree_;
  std::vector<bool> is_instance_;
  PageVector<Reference> references_;
  Trees trees_;  // indices in tree_.meshes
};

/// Returns an upper bound of the memory of a build, in which each shared mesh counts once, unless
/// placements have no instance_box().
[[nodiscard]] std::uint64_t memory_to_build(const Primitives& primitives);

}  // namespace microtrace::build
