#pragma once
/// Memory layout of the tree, as the builder writes and the kernels read it. Plain data without
/// functions of external linkage, because kernels for several instruction sets include it.

#include <cstdint>

namespace microtrace {

inline constexpr int kWidth = 8;  ///< children per node, triangles per block

/// A reference to a child: none, a node, or a leaf.
using ChildRef = std::uint32_t;

/// An inner node: the boxes of up to eight children, with one array per bounding plane. Unused
/// slots have the empty box (lo = +infinity, hi = -infinity), which no ray enters. A box contains
/// every point of its subtree.
struct alignas(64) WideNode {
  float lo_x[kWidth], lo_y[kWidth], lo_z[kWidth];
  float hi_x[kWidth], hi_y[kWidth], hi_z[kWidth];
  ChildRef child[kWidth];
};
static_assert(sizeof(WideNode) == 256);  // 224 and padding: four cache lines

/// Up to eight triangles of moderate size (every |coordinate| at most 2^38) with the vertices a, b,
/// c of the scene. Each triangle starts at the vertex between its two shorter edges, which keeps
/// the error bounds of thin triangles small. Unused slots have NaN in a and are never hit.
struct alignas(64) TriangleBlock {
  float a_x[kWidth], a_y[kWidth], a_z[kWidth];
  float b_x[kWidth], b_y[kWidth], b_z[kWidth];
  float c_x[kWidth], c_y[kWidth], c_z[kWidth];
  float largest_edge;  ///< upper bound of every |component| of e1 = fl(b - a) and e2 = fl(c - a)
  float edge_product;  ///< the same for |component of e1| times |component of e2|
  std::uint32_t id[kWidth];  ///< PrimitiveId; mostly in a cache line that only hits access
};
static_assert(sizeof(TriangleBlock) == 384);

/// Leaves refer to `count` consecutive blocks, or to `count` consecutive entries of the list of
/// other bounded primitives. Bits 31-30: 0 node, 1 triangle blocks, 2 other primitives. Nodes have
/// their index in bits 29-0; leaves have their first entry in bits 29-3 and count - 1 in bits 2-0.
namespace child_ref {
inline constexpr ChildRef kTriangles = 1U << 30U;
inline constexpr ChildRef kOthers = 2U << 30U;
inline constexpr ChildRef kKind = 3U << 30U;
inline constexpr std::uint32_t kMaxNodes = 1U << 30U;
inline constexpr std::uint32_t kMaxLeafEntries = 1U << 27U;
inline constexpr std::uint32_t kMaxLeafCount = 8;
}  // namespace child_ref

}  // namespace microtrace
