#pragma once
/// The trees of meshes that objects share, and the instances that place them.

#include "accel/build/float4.hpp"
#include "accel/build/tree.hpp"

#include <microtrace/array.hpp>
#include <microtrace/shape.hpp>

#include <cstddef>
#include <optional>

namespace microtrace {

/// A tree of a mesh's triangles in the mesh's own space.
struct OwnedMeshTree {
  Tree tree;
  MeshTree view{};  ///< refers to `tree`
  /// The arrays of the mesh, if they are shared, so that their addresses identify the mesh as long
  /// as this object exists.
  Array<Vec3> positions;
  Array<std::array<std::uint32_t, 3>> triangles;

  OwnedMeshTree(const Mesh& mesh, const BuildOptions& options);
  OwnedMeshTree(const OwnedMeshTree&) = delete;
  OwnedMeshTree& operator=(const OwnedMeshTree&) = delete;

  /// True if the mesh has the same arrays as the one of this tree.
  [[nodiscard]] bool is_of(const Mesh& mesh) const;
};

namespace build {

/// Returns the box of a placed mesh, which contains the transformed triangles. Nothing if the mesh
/// can't be an instance: if the placement is singular or nearly so, if it scales by more than 2^16
/// or less than 2^-16, if the result exceeds the range of blocks, or if all of its coordinates are
/// below 2^-100.
[[nodiscard]] std::optional<Box> instance_box(const OwnedMeshTree& tree, const PlacedMesh& mesh);

/// Returns the instance of a mesh with this tree and this instance_box(), except for its first id
/// and the index of its mesh. It refers to the placement.
[[nodiscard]] Instance make_instance(const Tree& of_mesh, const Placement& placement,
                                     const Box& box);

}  // namespace build
}  // namespace microtrace
