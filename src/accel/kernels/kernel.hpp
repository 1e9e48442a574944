#pragma once
/// What the kernels of every instruction set have in common: their input, their state, their table.
/// Plain data only; see simd.hpp for why.

#include "accel/layout.hpp"

#include <cstdint>

namespace microtrace {

struct TreeView {
  const WideNode* nodes;
  const TriangleBlock* blocks;
  const std::uint32_t* others;
  ChildRef root;
};

/// The nearest hit so far: its exact t is within [lo, hi]. Before there is one, lo = hi = t_max and
/// id is kNoPrimitive.
struct Best {
  float lo, hi;
  std::uint32_t id;
};
inline constexpr std::uint32_t kNoPrimitive = ~0U;

/// Decides what float32 can't: whether primitive id is hit, and before the best so far. Updates
/// best.
struct SlowPath {
  void* context;
  void (*consider)(void* context, std::uint32_t id, Best& best);
};

/// The limits within which rays and triangles go to kernels. They keep every float32 result free of
/// overflow, and what underflow adds below 2^-100.
inline constexpr float kFarthestCoordinate = 0x1p38F;  ///< every |o_i|, t_min, corner
inline constexpr float kLongestDirection = 0x1p20F;    ///< every |d_i|
inline constexpr float kShortestDirection = 0x1p-20F;  ///< the largest |d_i|

/// Most rays begin at the least number above 0, and processors calculate slowly with subnormal
/// numbers: culling begins at 0 instead, which only culls less.
inline constexpr float kLeastBegin = 0x1p-100F;

/// A ray as kernels take it, within the limits.
struct KernelRay {
  float o[3], d[3];
  float t_min, t_max;  ///< hits that are not certainly from t_min on go to the slow path
  float t_begin;       ///< hits certainly before it are left out; t_min, or 0 where that is tiny
  // ---- by the kernel:
  float near_factor[3], far_factor[3];  ///< see slabs.hpp
  float d_sum;                          ///< |d_x| + |d_y| + |d_z|, rounded up
  /// Where in a WideNode, counted in floats, the planes begin through which the ray enters and
  /// leaves boxes.
  std::uint32_t near_plane[3], far_plane[3];
};

inline constexpr int kTileRays = 64;
/// Rays that are culled together within a tile: two rows of eight pixels.
inline constexpr int kGroupRays = 16, kGroups = kTileRays / kGroupRays;

/// Directions within centre +- radius, axis by axis.
struct Beam {
  float centre[3], radius[3];
};

/// Where a triangle lies in the tree: its block's index times kWidth, plus its lane.
inline constexpr std::uint32_t kNoPlace = ~0U;

/// Rays with a common origin, best nearly parallel; an array for each of their parts. The limits
/// are KernelRay's. Places beyond the last ray repeat it and hit nothing.
struct alignas(64) KernelTile {
  float d[3][kTileRays];
  float t_min[kTileRays];
  float best_lo[kTileRays], best_hi[kTileRays];  ///< as in Best
  std::uint32_t best_id[kTileRays];
  std::uint32_t best_place[kTileRays];  ///< of the best hit, kNoPlace unless it's a mesh's triangle
  float o[3];
  int count;                                    ///< of rays
  float near[3][kTileRays], far[3][kTileRays];  ///< near_factor and far_factor of each ray
  float t_begin[kTileRays];                     ///< t_min, or 0 where that is tiny
  float least_t_begin;                          ///< of all rays
  Beam beam, group_beam[kGroups];               ///< of all rays, of each group
  float d_sum;          ///< at least |d_x| + |d_y| + |d_z| of any direction of the beam
  bool negative[3];     ///< whether d_i is below zero, for axes where that is the same for all rays
  bool common_sign[3];  ///< whether it is, and no d_i is so small that 1 / d_i overflows
  float least_near[3], greatest_near[3];  ///< of the factors, for axes with a common sign
  float least_far[3], greatest_far[3];
};

/// SlowPath for a tile.
struct TileSlowPath {
  void* context;
  /// One ray.
  void (*consider)(void* context, int ray, std::uint32_t id, Best& best);
  /// All rays of the tile.
  void (*consider_all)(void* context, std::uint32_t id, KernelTile& tile);
};

/// Whole tiles; no power of two, so that the parts of a ray do not share a cache set.
inline constexpr int kStreamRays = 31 * kTileRays;

/// Unrelated rays, an array for each of their parts. The caller fills what stands above the line,
/// for `count` rays, and t_max into best_hi.
struct alignas(64) KernelStream {
  float o[3][kStreamRays], d[3][kStreamRays];
  float t_min[kStreamRays];
  float best_hi[kStreamRays];  ///< as in Best
  int count;
  // ---- by prepare_stream:
  /// A bit for each ray that is valid and within KernelRay's limits. Some other ray takes the place
  /// of one that is not; the answer to it is of no use.
  std::uint64_t suited[kStreamRays / 64];
  float best_lo[kStreamRays];  ///< as in Best
  std::uint32_t best_id[kStreamRays];
  float near[3][kStreamRays], far[3][kStreamRays];  ///< near_factor and far_factor of each ray
  float t_begin[kStreamRays];                       ///< t_min, or 0 where that is tiny
  float d_sum[kStreamRays];                         ///< as in KernelRay
};

/// SlowPath for a stream.
struct StreamSlowPath {
  void* context;
  void (*consider)(void* context, int ray, std::uint32_t id, Best& best);
};

inline constexpr int kHitBatch = kTileRays;

/// Hits of triangles, an array for each coordinate. Places without a hit may hold anything.
struct alignas(64) HitBatch {
  float a[3][kHitBatch], b[3][kHitBatch], c[3][kHitBatch];  ///< corners
  const float *o[3], *d[3];                                 ///< of kHitBatch rays that suit kernels
  float t[kHitBatch];                                       ///< the answers
};

/// A small box, closed, and what was found there.
struct PlaceQuery {
  static constexpr int kMost = 32;

  float lo[3], hi[3];
  int count;                    ///< of places; -1: more than kMost
  std::uint32_t places[kMost];  ///< as KernelTile::best_place; kOtherPlace + that in the others
};
inline constexpr std::uint32_t kOtherPlace = 1U << 31U;
inline constexpr int kPlaceQueries = 16;

/// One instruction set's code.
struct Kernels {
  const char* name;
  /// Updates best to the nearest hit of the tree, where that is nearer.
  void (*closest)(const TreeView& tree, KernelRay ray, const SlowPath& slow, Best& best);
  /// Whether there is any hit within the ray's range.
  bool (*any)(const TreeView& tree, KernelRay ray, const SlowPath& slow);
  /// Fills a tile without hits with up to kTileRays rays, each eight numbers: o, t_min, d, t_max.
  /// False if their origins differ or one is not valid or beyond the limits; then the tile is of no
  /// use.
  bool (*fill_tile)(const float* rays, int count, KernelTile& tile);
  /// The same as closest for all rays of a prepared tile.
  void (*closest_of_tile)(const TreeView& tree, KernelTile& tile, const TileSlowPath& slow);
  /// Fills the lower part of a stream, without hits.
  void (*prepare_stream)(KernelStream& stream);
  /// The same as closest for all rays of a prepared stream.
  void (*closest_of_stream)(const TreeView& tree, KernelStream& stream, const StreamSlowPath& slow);
  /// Gives every ray without a best hit some hit within its range, if there is one.
  void (*any_of_stream)(const TreeView& tree, KernelStream& stream, const StreamSlowPath& slow);
  /// Fills t with the exact parameters rounded to nearest; returns the set of hits for which that
  /// is certain.
  std::uint64_t (*round_t)(HitBatch& hits);
  /// The same for the hits of a tile that have a place.
  std::uint64_t (*round_t_of_tile)(const TreeView& tree, const KernelTile& tile, float* t);
  /// Finds all primitives with a point in each query's box, some maybe twice, and others that may:
  /// triangles whose own boxes have one, and what is in a leaf of others. Up to kPlaceQueries at a
  /// time, whose ways to memory overlap.
  void (*touching)(const TreeView& tree, PlaceQuery* queries, int count);
  /// How many triangles' edges this thread has looked at by float64.
  std::uint64_t (*edge_tests)();
};

extern const Kernels kPortableKernels;
#if defined(__x86_64__)
extern const Kernels kAvx2Kernels;
extern const Kernels kAvx512Kernels;
#endif

}  // namespace microtrace
