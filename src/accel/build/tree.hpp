#pragma once
/// The bounding volume hierarchy over a scene's primitives: eight children per node, built by the
/// surface area heuristic.

#include "accel/build/page_allocator.hpp"
#include "accel/build/references/duplicates.hpp"
#include "accel/layout.hpp"

#include <microtrace/primitives.hpp>

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace microtrace {

struct Tree;

struct BuildOptions {
  bool fast = false;     ///< builds faster with fewer candidate splits, for previews
  unsigned threads = 0;  ///< 0: default_threads(). The tree is the same for any number.
  /// A tree to be refitted if it has the same primitives in other positions and its cost grows by
  /// at most this factor. It is released before another tree is built.
  std::shared_ptr<const Tree> previous{};
  double max_cost_growth = 1;
};

/// World-space bounds, closed; empty if lo > hi.
struct Bounds {
  Vec3 lo{std::numeric_limits<float>::infinity()};
  Vec3 hi{-std::numeric_limits<float>::infinity()};
};

/// The expected cost of a ray by the surface area heuristic, relative to the surface area of the
/// tree's box, and to that of its primitives' boxes. The first detects primitives that grow, the
/// second parts of the scene that move away from each other.
struct RelativeCost {
  double to_tree = 0, to_primitives = 0;
};

/// Maximum number of nodes on a path from the root.
inline constexpr int kMaxDepth = 64;

/// Every nonempty primitive is in a leaf, in `unbounded`, or a duplicate of a primitive in a leaf.
struct Tree {
  PageVector<WideNode> nodes;
  PageVector<TriangleBlock> blocks;    ///< triangles with every |coordinate| at most 2^38
  std::vector<PrimitiveId> others;     ///< larger triangles, spheres, discs
  std::vector<PrimitiveId> unbounded;  ///< planes, quadrics, and shapes beyond the float32 range
  Duplicates duplicates;               ///< primitives with the same points as one in the tree
  ChildRef root = 0;                   ///< a node without children if there are no leaves
  Bounds bounds;                       ///< bounds of all leaves

  // For refitted().
  std::size_t primitives = 0;                ///< in leaves
  double area = 0;                           ///< References::area
  std::optional<RelativeCost> built_cost{};  ///< relative cost when the tree was built, for a
                                             ///< refitted tree
};

/// The scene of the primitives must outlive only this call. Throws Error (limit) if the tree would
/// exceed its 32-bit references.
[[nodiscard]] Tree build_tree(const Primitives& primitives, BuildOptions options);

}  // namespace microtrace
