#pragma once
/// The bounding volume hierarchy over a scene's primitives, with up to eight children per node,
/// built by the surface area heuristic.

#include "accel/build/references/duplicates.hpp"
#include "accel/layout.hpp"

#include <microtrace/page_allocator.hpp>
#include <microtrace/primitives.hpp>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace microtrace {

struct Tree;
struct OwnedMeshTree;

/// Upper bound of the memory per primitive during a build, including pieces of split triangles.
inline constexpr std::uint64_t kBytesOfPrimitive = 120;
/// What this memory is for, in error messages.
inline constexpr const char* kTreeMemory = "the tree of primitives";

struct BuildOptions {
  bool fast = false;     ///< builds faster with fewer candidate splits, for previews
  unsigned threads = 0;  ///< 0: default_threads(). The tree does not depend on this number.
  /// A tree to refit if it has the same primitives at different positions and its cost grows at
  /// most by the factor max_cost_growth. Otherwise this tree is released before a new one is built.
  std::shared_ptr<const Tree> previous{};
  double max_cost_growth = 1;
  /// In scenes with at most this number of primitives, those that are tested faster one by one are
  /// kept out of the tree.
  PrimitiveId few = 0;
  /// Stores all triangles that are the same set of points, instead of one of them.
  bool keeps_duplicates = false;
};

/// A closed bounding box in scene coordinates; empty if lo > hi.
struct Bounds {
  Vec3 lo{std::numeric_limits<float>::infinity()};
  Vec3 hi{-std::numeric_limits<float>::infinity()};
};

/// The expected cost of a ray by the surface area heuristic, relative to the surface area of the
/// tree's box (`to_tree`) and to the total surface area of the primitives' boxes (`to_primitives`).
/// The first ratio grows if primitives grow; the second grows if parts of the scene move away from
/// each other.
struct RelativeCost {
  double to_tree = 0, to_primitives = 0;
};

/// Maximum number of nodes on a path from the root.
inline constexpr int kMaxDepth = 64;

/// The tree. Every nonempty primitive is in a leaf, in `unbounded`, in an instance, or a duplicate
/// of a primitive in a leaf.
struct Tree {
  PageVector<WideNode> nodes;
  PageVector<TriangleBlock> blocks;  ///< triangles with every |coordinate| at most 2^38
  std::vector<PrimitiveId> others;   ///< larger triangles, spheres, discs, ellipsoids
  /// Planes, other quadrics, shapes beyond the float32 range, and primitives of scenes with so few
  /// of them that testing each is faster.
  std::vector<PrimitiveId> unbounded;
  std::vector<std::shared_ptr<const OwnedMeshTree>> meshes;  ///< the trees of instances
  std::vector<MeshTree> views;                               ///< of `meshes`
  /// Refer to `views` and to placements in the scene.
  PageVector<Instance> instances;  ///< in the order of the leaves
  Duplicates duplicates;           ///< triangles equal to one in the tree
  ChildRef root = 0;               ///< a node without children if there are no leaves
  Bounds bounds;                   ///< bounds of all leaves

  [[nodiscard]] bool has_leaves() const {
    return !blocks.empty() || !others.empty() || !instances.empty();
  }

  // The following members are for refitted().
  std::size_t primitives = 0;                ///< number of primitives in leaves
  double area = 0;                           ///< see References::area
  std::optional<RelativeCost> built_cost{};  ///< for a refitted tree, its cost when it was built
};

/// Builds or refits a tree, which refers to the scene only by its instances' placements. Throws
/// Error (limit) if there are more primitives than 32-bit references can address.
[[nodiscard]] Tree build_tree(const Primitives& primitives, BuildOptions options);

}  // namespace microtrace
