#pragma once
/// The bounding volume hierarchy over a scene's primitives: eight children per node, built by the
/// surface area heuristic.

#include "accel/build/duplicates.hpp"
#include "accel/build/page_allocator.hpp"
#include "accel/layout.hpp"

#include <microtrace/primitives.hpp>

#include <limits>
#include <vector>

namespace microtrace {

struct BuildOptions {
  bool fast = false;     ///< a quick build for previews, with fewer candidates for splits
  unsigned threads = 0;  ///< 0: default_threads(). The tree is the same for any number.
};

/// World space, closed; empty if lo > hi.
struct Bounds {
  Vec3 lo{std::numeric_limits<float>::infinity()};
  Vec3 hi{-std::numeric_limits<float>::infinity()};
};

/// Maximum number of nodes on a path from the root.
inline constexpr int kMaxDepth = 64;

/// Every nonempty primitive is in a leaf, in `unbounded`, or a duplicate of a primitive in a leaf.
struct Tree {
  PageVector<WideNode> nodes;
  PageVector<TriangleBlock> blocks;    ///< triangles with every |coordinate| at most 2^38
  std::vector<PrimitiveId> others;     ///< larger triangles, spheres, discs
  std::vector<PrimitiveId> unbounded;  ///< planes, quadrics, and what leaves the float32 range
  Duplicates duplicates;  ///< primitives represented by another one with the same points
  ChildRef root = 0;      ///< a node without children if there are no leaves
  Bounds bounds;          ///< bounds of all leaves
};

/// The scene of the primitives must outlive only this call. Throws Error (limit) if the tree would
/// exceed its 32-bit references.
[[nodiscard]] Tree build_tree(const Primitives& primitives, const BuildOptions& options);

}  // namespace microtrace
