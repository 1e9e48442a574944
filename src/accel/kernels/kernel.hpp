#pragma once
/// Types shared by the kernels of all instruction sets: input, state, and the table of functions.
/// Plain data only; see simd.hpp for the reason.

#include "accel/layout.hpp"

#include <cstdint>

namespace microtrace {

struct TreeView {
  const WideNode* nodes;
  const TriangleBlock* blocks;
  const std::uint32_t* others;
  ChildRef root;
};

/// The nearest hit so far: its exact t is within [lo, hi]. Initially lo = hi = t_max and id is
/// kNoPrimitive.
struct ClosestSoFar {
  float lo, hi;
  std::uint32_t id;
};
inline constexpr std::uint32_t kNoPrimitive = ~0U;

/// Decides a hit that float32 can't decide: whether primitive `id` is hit, and whether before the
/// nearest hit so far. Updates best.
struct Fallback {
  void* context;
  void (*consider)(void* context, std::uint32_t id, ClosestSoFar& best);
};

/// Limits of the rays and triangles in kernels. Within them no float32 result overflows, and
/// underflow adds less than 2^-100.
inline constexpr float kFarthestCoordinate = 0x1p38F;  ///< every |o_i|, t_min, vertex coordinate
inline constexpr float kLongestDirection = 0x1p20F;    ///< every |d_i|
inline constexpr float kShortestDirection = 0x1p-20F;  ///< the largest |d_i|

/// Culling starts at 0 if t_min is below this number. Most rays start at the least float above 0,
/// and processors are slow with subnormal numbers. Culling less is always valid.
inline constexpr float kLeastBegin = 0x1p-100F;

/// A ray in the kernels' form, within the limits.
struct KernelRay {
  float o[3], d[3];
  float t_min, t_max;        ///< the fallback decides hits that are not certainly at or after t_min
  float t_begin;             ///< hits certainly before it are dropped; t_min, or 0 if t_min is tiny
  std::uint32_t omitted_id;  ///< a triangle that the ray certainly doesn't hit, or kNoPrimitive
  // ---- set by the kernel:
  float near_factor[3], far_factor[3];  ///< see slabs.hpp
  float d_sum;                          ///< |d_x| + |d_y| + |d_z|, rounded up
  /// Offsets in a WideNode, in floats, of the planes through which the ray enters and leaves boxes.
  std::uint32_t near_plane[3], far_plane[3];
};

inline constexpr int kPacketRays = 64;
/// Rays of a packet that are culled together: two rows of eight pixels.
inline constexpr int kGroupRays = 16, kGroups = kPacketRays / kGroupRays;

/// Directions within center +- radius on each axis.
struct Beam {
  float center[3], radius[3];
};

/// The slot of a triangle in the tree: its block's index times kWidth, plus its lane.
inline constexpr std::uint32_t kNoSlot = ~0U;

/// Rays with a common origin, preferably nearly parallel; one array per component. Within the
/// limits of KernelRay. Slots after the last ray repeat it and hit nothing.
struct alignas(64) KernelPacket {
  float d[3][kPacketRays];
  float t_min[kPacketRays];
  float best_lo[kPacketRays], best_hi[kPacketRays];  ///< as in ClosestSoFar
  std::uint32_t best_id[kPacketRays];
  std::uint32_t best_slot[kPacketRays];  ///< slot of the nearest hit if it is a mesh triangle
  float o[3];
  int count;                                        ///< number of rays
  float near[3][kPacketRays], far[3][kPacketRays];  ///< near_factor and far_factor of each ray
  float t_begin[kPacketRays];                       ///< t_min, or 0 if it is tiny
  float least_t_begin;                              ///< least t_begin of all rays
  Beam beam, group_beam[kGroups];                   ///< beams of all rays and of each group
  float d_sum;          ///< upper bound of |d_x| + |d_y| + |d_z| for all directions of the beam
  bool negative[3];     ///< sign of d_i, for axes where it is common to all rays
  bool common_sign[3];  ///< whether the sign is common, and no d_i is so small that 1 / d_i
                        ///< overflows
  float least_near[3], greatest_near[3];  ///< bounds of the factors, for axes with a common sign
  float least_far[3], greatest_far[3];
};

/// Fallback for a packet.
struct PacketFallback {
  void* context;
  /// Considers primitive id for one ray.
  void (*consider)(void* context, int ray, std::uint32_t id, ClosestSoFar& best);
  /// Considers primitive id for all rays.
  void (*consider_all)(void* context, std::uint32_t id, KernelPacket& packet);
};

/// A multiple of the packet size, but no power of two, so that the components of a ray are not in
/// the same cache set.
inline constexpr int kStreamRays = 31 * kPacketRays;

/// Incoherent rays, one array per component. The caller fills the members above the line for
/// `count` rays, and best_hi with t_max.
struct alignas(64) KernelStream {
  float o[3][kStreamRays], d[3][kStreamRays];
  float t_min[kStreamRays];
  float best_hi[kStreamRays];             ///< as in ClosestSoFar
  std::uint32_t omitted_id[kStreamRays];  ///< as in KernelRay
  int count;
  // ---- set by prepare_stream:
  /// One bit per ray that is valid and within KernelRay's limits. Other rays are replaced by some
  /// valid ray, and their results are meaningless.
  std::uint64_t suited[kStreamRays / 64];
  float best_lo[kStreamRays];  ///< as in ClosestSoFar
  std::uint32_t best_id[kStreamRays];
  float near[3][kStreamRays], far[3][kStreamRays];  ///< near_factor and far_factor of each ray
  float t_begin[kStreamRays];                       ///< t_min, or 0 if it is tiny
  float d_sum[kStreamRays];                         ///< as in KernelRay
};

/// Fallback for a stream.
struct StreamFallback {
  void* context;
  void (*consider)(void* context, int ray, std::uint32_t id, ClosestSoFar& best);
};

inline constexpr int kHitBatch = kPacketRays;

/// Hits of triangles, one array per coordinate. Slots without a hit may have any values.
struct alignas(64) HitBatch {
  float a[3][kHitBatch], b[3][kHitBatch], c[3][kHitBatch];  ///< vertices
  const float *o[3], *d[3];  ///< of kHitBatch rays within the kernels' limits
  float t[kHitBatch];        ///< results
};

/// A query for the primitives near a small closed box, and its results. Triangles that are not
/// wanted are omitted: a given one, and those within an axis-aligned plane.
struct BoxQuery {
  static constexpr int kMost = 32;

  float lo[3], hi[3];
  std::uint32_t omitted_id = kNoPrimitive;
  int plane_axis = -1;         ///< -1: no plane
  float plane_at = 0;          ///< its coordinate on this axis
  int count;                   ///< number of slots; -1: more than kMost
  std::uint32_t slots[kMost];  ///< slots as in KernelPacket::best_slot; kOtherSlot + index for
                               ///< other primitives
};
inline constexpr std::uint32_t kOtherSlot = 1U << 31U;
inline constexpr int kBoxQueries = 16;

/// The functions of one instruction set.
struct Kernels {
  const char* name;
  /// Updates best if the tree has a nearer hit.
  void (*closest)(const TreeView& tree, KernelRay ray, const Fallback& slow, ClosestSoFar& best);
  /// Returns whether there is any hit within the ray's interval.
  bool (*any)(const TreeView& tree, KernelRay ray, const Fallback& slow);
  /// Fills a packet, without hits, with up to kPacketRays rays of eight numbers each: o, t_min, d,
  /// t_max. Returns false if their origins differ or a ray is invalid or beyond the limits; the
  /// packet is then unusable.
  bool (*fill_packet)(const float* rays, int count, KernelPacket& packet);
  /// As closest, for all rays of a prepared packet.
  void (*closest_of_packet)(const TreeView& tree, KernelPacket& packet, const PacketFallback& slow);
  /// Fills the lower part of a stream, without hits.
  void (*prepare_stream)(KernelStream& stream);
  /// As closest, for all rays of a prepared stream.
  void (*closest_of_stream)(const TreeView& tree, KernelStream& stream, const StreamFallback& slow);
  /// Finds any hit within the interval for every ray that has none yet.
  void (*any_of_stream)(const TreeView& tree, KernelStream& stream, const StreamFallback& slow);
  /// Fills t with the exact parameters rounded to nearest; returns the set of hits for which the
  /// result is certain.
  std::uint64_t (*round_t)(HitBatch& hits);
  /// The same for the hits of a packet that have a slot.
  std::uint64_t (*round_t_of_packet)(const TreeView& tree, const KernelPacket& packet, float* t);
  /// Finds all primitives with a point in each query's box. May return a primitive twice, and may
  /// return others: triangles whose bounding boxes overlap the query's box, and all primitives of a
  /// visited leaf of other primitives. Processes up to kBoxQueries at a time, whose memory accesses
  /// overlap.
  void (*touching)(const TreeView& tree, BoxQuery* queries, int count);
  /// The number of triangle edge tests in float64 by this thread.
  std::uint64_t (*edge_tests)();
};

extern const Kernels kPortableKernels;
#if defined(__x86_64__)
extern const Kernels kAvx2Kernels;
extern const Kernels kAvx512Kernels;
#endif

}  // namespace microtrace
