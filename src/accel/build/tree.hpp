#pragma once
/// The bounding volume hierarchy over a scene's primitives: eight-wide, built by the surface area
/// heuristic.

#include "accel/build/page_allocator.hpp"
#include "accel/build/twins.hpp"
#include "accel/layout.hpp"

#include <microtrace/primitives.hpp>

#include <limits>
#include <vector>

namespace microtrace {

struct BuildOptions {
  bool fast = false;     ///< a quick build for previews: fewer candidates are looked at
  unsigned threads = 0;  ///< 0: default_threads(). The tree is the same for any number.
};

/// World space, closed; empty if lo > hi.
struct Bounds {
  Vec3 lo{std::numeric_limits<float>::infinity()};
  Vec3 hi{-std::numeric_limits<float>::infinity()};
};

/// No path from the root visits more nodes than this.
inline constexpr int kMaxDepth = 64;

/// Every primitive that a ray can hit is in a leaf, in `unbounded` or among the twins of one in a
/// leaf. Those that are empty by definition are nowhere.
struct Tree {
  PageVector<WideNode> nodes;
  PageVector<TriangleBlock> blocks;    ///< triangles with every |coordinate| at most 2^38
  std::vector<PrimitiveId> others;     ///< larger triangles, spheres, discs
  std::vector<PrimitiveId> unbounded;  ///< planes, quadrics, and what leaves the float32 range
  Twins twins;                         ///< those that others stand for
  ChildRef root = 0;                   ///< a node without children if there is no leaf
  Bounds bounds;                       ///< of all leaves
};

/// The scene behind the primitives must outlive the call only. Throws Error (limit) if the tree
/// would not fit its 32-bit references.
[[nodiscard]] Tree build_tree(const Primitives& primitives, const BuildOptions& options);

}  // namespace microtrace
