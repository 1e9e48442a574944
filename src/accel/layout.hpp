#pragma once
/// The memory layout of the tree that the builder writes and the kernels read. Kernels for several
/// instruction sets include this header, so it has no functions of external linkage, whose copies
/// the linker would merge.

#include <cstddef>
#include <cstdint>

namespace microtrace {

inline constexpr int kWidth = 8;  ///< number of children per node and of triangles per block

/// A reference to a child, which is a node or a leaf; see child_ref.
using ChildRef = std::uint32_t;

/// An inner node: the boxes of up to eight children, with one array per bounding plane. A box
/// contains every point of its subtree. Unused slots have the empty box (lo = +infinity, hi =
/// -infinity), which no ray enters.
struct alignas(32) WideNode {
  float lo_x[kWidth], lo_y[kWidth], lo_z[kWidth];
  float hi_x[kWidth], hi_y[kWidth], hi_z[kWidth];
  ChildRef child[kWidth];
};
static_assert(sizeof(WideNode) == 224);  // in four cache lines

/// Up to eight triangles with every |coordinate| at most 2^38, which share up to sixteen vertices.
/// The vertices a, b and c of a triangle are the scene's, rotated so that a is the vertex between
/// the two shorter edges, which keeps the error bounds of thin triangles small. The vertices of
/// unused slots are NaN, so that these slots are never hit.
struct alignas(64) TriangleBlock {
  static constexpr unsigned kVertices = 16;
  /// A block has room for this number of triangles even if they share no vertices.
  static constexpr unsigned kUnshared = 5;

  float vertices[3][kVertices];  ///< x, y and z of each vertex
  /// The indices of a, b and c for each slot, in the lower four bits. The upper bits of that of a
  /// are a's number in the scene's triangle, 0 to 2.
  std::uint8_t corners[3][kWidth];
  float largest_edge;  ///< upper bound of every |component| of e1 = fl(b - a) and e2 = fl(c - a)
  float edge_product;  ///< upper bound of every |component of e1| times |component of e2|
  std::uint32_t id[kWidth];  ///< PrimitiveIds
};
static_assert(sizeof(TriangleBlock) == 256);

namespace {

/// Returns a coordinate of a triangle's vertex: 0 (a), 1 (b) or 2 (c).
inline float coordinate(const TriangleBlock& block, int vertex, std::size_t slot, int axis) {
  return block.vertices[axis][block.corners[vertex][slot] % TriangleBlock::kVertices];
}
/// Which vertex of the scene's triangle in a slot is the block's first vertex.
inline unsigned scene_number(const TriangleBlock& block, std::size_t slot) {
  return block.corners[0][slot] / TriangleBlock::kVertices;
}

/// True if a slot holds a triangle.
inline bool is_used(const TriangleBlock& block, std::size_t slot) {
  const float x = coordinate(block, 0, slot, 0);
  return x == x;
}

}  // namespace

/// The triangles of a small tree, or the large ones of another tree, each once.
struct FewTriangles {
  static constexpr int kMost = 128;

  struct Box {
    float lo[3], hi[3];
  };
  struct Entry {
    float vertices[3][3];
    Box box;
    int plane_axis;          ///< of an axis-aligned plane that it lies in; -1: none
    float plane_at;          ///< its coordinate on this axis
    std::uint32_t id, slot;  ///< slot: the block's index times kWidth, plus the lane
  };
  /// An axis-aligned rectangle. Elements of arrays are for the axes i + 1 and i + 2 (modulo 3) if
  /// it is perpendicular to the axis i.
  struct Rectangle {
    float plane;               ///< coordinate on the axis i
    float middle[2];           ///< rounded
    float inner[2], outer[2];  ///< half of the extents, less and more by a bound of errors
    float per_edge[2];         ///< 1 / e1 and 1 / e2 of the facet
    float diagonal_error;      ///< bound of errors relative to the edges
  };
  /// A triangle (a, a + e1, a + e2), or two triangles that form a parallelogram up to rounding, of
  /// which this is the first: the other is (a + e1 + e2, a + e2, a + e1).
  struct Facet {
    float a[3], e1[3], e2[3];
    float n[3];  ///< e1 x e2
    /// The axis i of n if e1 and e2 are along the axes i + 1 and i + 2 (modulo 3) and the fourth
    /// corner is exact, otherwise kOblique.
    int axis;
    Rectangle rectangle;  ///< unless the axis is kOblique
    /// As in a block. For a parallelogram, edge_product is enlarged and height_slack is an
    /// additional error of heights, because of the rounding of its fourth corner.
    float largest_edge, edge_product, height_slack;
    Box box;            ///< of all its triangles
    int first, second;  ///< indices of its triangles; second is -1 if there is only one
  };
  Entry entries[kMost];
  int count;
  static constexpr int kOblique = 3;
  Facet facets[kMost];     ///< by ascending axis
  int ends[kOblique + 1];  ///< ends of the ranges of facets with each axis
};

/// A tree without the scene, and the numbers of its primitives within their mesh.
struct MeshTree {
  const WideNode* nodes;
  const TriangleBlock* blocks;
  const std::uint32_t* others;
  ChildRef root;
  std::uint32_t triangles;  ///< number of the mesh's triangles
};

/// An instance in a tree over instances: a mesh's own tree and its place in the scene. See
/// docs/exactness.md, "Instances".
struct Instance {
  const double* scene_from_mesh;  ///< three columns of the matrix and the translation
  std::uint32_t first_id;         ///< added to the numbers of the mesh's primitives
  std::uint32_t mesh : 31;        ///< index of the mesh's tree
  std::uint32_t is_mirrored : 1;  ///< 1 if front faces need another order of vertices
  float mesh_from_scene[3][3];    ///< rows of the inverse matrix, without the translation
  /// Bounds the displacement of a ray that enters the instance, see InnerRay. Upper bounds of the
  /// part that does not depend on the ray.
  float reach;
};
static_assert(sizeof(Instance) == 56);  // a scene may have millions

/// The encoding of ChildRef. Bits 31-30 hold the kind: 0 for a node, 1 for a leaf of triangle
/// blocks, 2 for a leaf of other bounded primitives, 3 for an instance. A node has its index in
/// bits 29-0. A leaf of kind 1 or 2 consists of `count` consecutive blocks or primitives, with the
/// index of the first in bits 29-3 and count - 1 in bits 2-0. An instance with index i is
/// kFirstInstance + i. Traversals use the remaining references of kind 3 as marks on their stacks.
namespace child_ref {
inline constexpr ChildRef kTriangles = 1U << 30U;
inline constexpr ChildRef kOthers = 2U << 30U;
inline constexpr ChildRef kKind = 3U << 30U;
inline constexpr ChildRef kFirstInstance = kKind + 1;
inline constexpr ChildRef kLastInstance = ~ChildRef{0} - 2;
/// Marks where the subtrees of an instance's mesh end on a stack.
inline constexpr ChildRef kInstanceEnd = kLastInstance + 1;
inline constexpr std::uint32_t kMaxInstances = kLastInstance - kFirstInstance;
inline constexpr std::uint32_t kMaxNodes = 1U << 30U;
inline constexpr std::uint32_t kMaxLeafEntries = 1U << 27U;
inline constexpr std::uint32_t kMaxLeafCount = 8;
}  // namespace child_ref

/// The range of a leaf's entries in the array for this kind of leaf.
struct LeafEntries {
  std::uint32_t begin, end;
};

namespace {

inline LeafEntries entries_of(ChildRef leaf) {
  const std::uint32_t begin = (leaf & ~child_ref::kKind) >> 3U;
  return {begin, begin + (leaf & 7U) + 1};
}

}  // namespace

}  // namespace microtrace
