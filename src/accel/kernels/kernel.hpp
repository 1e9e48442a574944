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

/// A ray as kernels take it: every |o_i| and t_min at most 2^38, the largest |d_i| within [2^-20,
/// 2^20]. These limits keep every float32 result below free of overflow, and what underflow adds
/// below 2^-100.
struct KernelRay {
  float o[3], d[3];
  float t_min, t_max;
  // ---- by the kernel:
  float near_factor[3], far_factor[3];  ///< see slabs.hpp
  float t_begin;                        ///< t_min, or 0 where that is tiny
  float d_sum;                          ///< |d_x| + |d_y| + |d_z|, rounded up
  bool negative[3];
};

inline constexpr int kTileRays = 64;

/// Rays with a common origin, best nearly parallel; an array for each of their parts. The limits
/// are KernelRay's. The caller fills what stands above the line; places beyond the last ray repeat
/// one with best_hi = -infinity, so that it hits nothing.
struct alignas(64) KernelTile {
  float d_x[kTileRays], d_y[kTileRays], d_z[kTileRays];
  float t_min[kTileRays];
  float best_lo[kTileRays], best_hi[kTileRays];  ///< as in Best
  std::uint32_t best_id[kTileRays];
  float o[3];
  // ---- by the kernel:
  float near[3][kTileRays], far[3][kTileRays];  ///< near_factor and far_factor of each ray
  float d_sum;                                  ///< the largest of all rays
  float t_begin[kTileRays];                     ///< t_min, or 0 where that is tiny
  float least_t_begin;                          ///< of all rays
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

/// One instruction set's code.
struct Kernels {
  const char* name;
  /// Updates best to the nearest hit of the tree, where that is nearer.
  void (*closest)(const TreeView& tree, KernelRay ray, const SlowPath& slow, Best& best);
  /// Whether there is any hit within the ray's range.
  bool (*any)(const TreeView& tree, KernelRay ray, const SlowPath& slow);
  /// The same as closest for all rays of a tile.
  void (*closest_of_tile)(const TreeView& tree, KernelTile& tile, const TileSlowPath& slow);
};

extern const Kernels kPortableKernels;
#if defined(__x86_64__)
extern const Kernels kAvx2Kernels;
extern const Kernels kAvx512Kernels;
#endif

}  // namespace microtrace
