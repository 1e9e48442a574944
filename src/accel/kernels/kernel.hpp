#pragma once
/// Types that the kernels for all instruction sets share: inputs, state, and the table of
/// functions. This header may contain only plain data, because kernels for several instruction sets
/// include it.

#include "accel/filters/seen_shapes.hpp"
#include "accel/layout.hpp"
#include "base/bit_set.hpp"

#include <microtrace/hit.hpp>

#include <cstdint>

namespace microtrace {

/// The triangles through which rays pass if they arrive at one of the sides.
struct OpenSide {
  BitPages triangles = nullptr;
  bool is_back = false;  ///< the side is the back instead of the front
};

struct TreeView {
  const WideNode* nodes;
  const TriangleBlock* blocks;
  const std::uint32_t* others;
  ChildRef root;
  const Instance* instances = nullptr;  ///< null if there are none
  const MeshTree* meshes = nullptr;     ///< of the instances
  /// Transforms a block of an instance's mesh to the scene, as Placement::point does.
  void (*scene_block)(const Instance& instance, const TriangleBlock& from,
                      TriangleBlock& to) = nullptr;
  /// Triangles that are tested without traversal: all primitives if few_are_all, otherwise those
  /// that the nodes leave out.
  const FewTriangles* few = nullptr;
  bool few_are_all = true;
  FewTriangles::Box rest{};  ///< contains what the nodes don't leave out, unless few_are_all
  OpenSide open{};           ///< for the rays of streams and packets
  /// Hits of rays of streams with these triangles count only where the triangles are visible, see
  /// StreamFallback.
  BitPages masked = nullptr;
};

/// The nearest hit so far, with its exact t in [lo, hi]. Initially lo = hi = t_max and id =
/// kNoPrimitive.
struct ClosestSoFar {
  float lo, hi;
  std::uint32_t id;
};

/// A callback for hits that float32 can't decide. If the ray hits primitive `id` before the nearest
/// hit so far, consider() sets `best` to this hit.
struct Fallback {
  void* context;
  void (*consider)(void* context, std::uint32_t id, ClosestSoFar& best);
};

/// Limits of the rays and triangles in kernels. Within these limits no float32 result overflows,
/// and underflow adds errors of less than 2^-100.
inline constexpr float kFarthestCoordinate = 0x1p38F;  ///< for |o_i|, t_min, |vertex coordinate|
inline constexpr float kLongestDirection = 0x1p20F;    ///< for every |d_i|
inline constexpr float kShortestDirection = 0x1p-20F;  ///< for the largest |d_i|

/// If t_min is below this number, hits are culled only before t = 0. Most rays start at the least
/// float above 0, and arithmetic with subnormal numbers is slow. Culling less is always valid.
inline constexpr float kLeastBegin = 0x1p-100F;

/// A ray for tests of boxes, see slabs.hpp.
struct BoxRay {
  float near_o[3], far_o[3];  ///< origins for the planes through which the ray enters and leaves
  float near_factor[3], far_factor[3];
  /// Offsets within a WideNode, counted in floats, of the planes through which the ray enters and
  /// leaves boxes.
  std::uint32_t near_plane[3], far_plane[3];
};

/// A ray in the kernels' form, within the limits above.
struct KernelRay {
  float o[3], d[3];
  float t_min, t_max;        ///< the fallback decides hits that are not certainly at or after t_min
  float t_begin;             ///< hits certainly before it are culled; t_min, or 0 below kLeastBegin
  std::uint32_t omitted_id;  ///< a triangle that is not tested, or kNoPrimitive
  // ---- set by the kernel:
  BoxRay box;
  float d_sum;  ///< |d_x| + |d_y| + |d_z|, rounded up
};

inline constexpr int kPacketRays = 64;
/// The rays of a packet are culled in groups, each usually of 4 x 4 pixels.
inline constexpr int kGroupRays = 16, kGroups = kPacketRays / kGroupRays;

/// A set of directions: center +- radius on each axis.
struct Beam {
  float center[3], radius[3];
};

/// A beam around the directions of each group.
struct alignas(16) GroupBeams {
  float center[3][kGroups], radius[3][kGroups];
};

inline constexpr int kHitBatch = kPacketRays;

/// Hits of triangles. Elements without a hit may have any values.
struct alignas(64) HitBatch {
  float a[3][kHitBatch], b[3][kHitBatch], c[3][kHitBatch];  ///< vertices
  const float *o[3], *d[3];  ///< origins and directions, within the kernels' limits
  float t[kHitBatch];        ///< resulting parameters
};

/// Triangles that are or were the nearest hits of a packet's rays.
struct alignas(64) PacketHits {
  static constexpr std::uint32_t kMost = 2 * kPacketRays;
  static constexpr std::uint32_t kNone = ~0U;  ///< stands for no index

  float a[3][kMost], b[3][kMost], c[3][kMost];  ///< vertices
  std::uint32_t count;
};

/// What the near_factor and the far_factor of several rays have in common, by axis.
struct FactorBounds {
  bool negative[3];     ///< true if d_i is negative for all rays; valid if common_sign
  bool common_sign[3];  ///< true if all d_i have the same sign and no 1 / d_i overflows
  float least_near[3], greatest_near[3];  ///< bounds of the factors; valid if common_sign
  float least_far[3], greatest_far[3];
  bool all_common;  ///< common_sign on all axes
};

/// The rays of a packet for tests of boxes, see slabs.hpp.
struct alignas(64) PacketBoxRays {
  float near[3][kPacketRays], far[3][kPacketRays];  ///< near_factor and far_factor of each ray
  float o_of_lo[3], o_of_hi[3];  ///< origins for the lower and the upper planes of boxes
  FactorBounds bounds;
};

/// Rays with a common origin within the limits of KernelRay, stored in one array per component.
/// Traversal is fastest if the rays are nearly parallel. Elements after the last ray repeat the
/// last ray, but hit nothing.
struct alignas(64) KernelPacket {
  float d[3][kPacketRays];
  float t_min[kPacketRays];
  float best_lo[kPacketRays], best_hi[kPacketRays];  ///< as in ClosestSoFar
  std::uint32_t best_id[kPacketRays];
  /// The index of the nearest hit's triangle in `hits`. kNone if the hit is another shape.
  std::uint32_t best_index[kPacketRays];
  PacketHits hits;
  float o[3];
  int count;                  ///< number of rays
  const std::uint8_t* order;  ///< the index of the ray at each place, see packet_order.hpp
  PacketBoxRays boxes;
  float t_begin[kPacketRays];  ///< as in KernelRay
  float least_t_begin;         ///< the least t_begin of all rays
  Beam beam;                   ///< contains the directions of all rays
  GroupBeams group_beams;
  float d_sum;  ///< upper bound of |d_x| + |d_y| + |d_z| for all directions of the beam
};

/// Callbacks for hits of a packet's rays that float32 can't decide.
struct PacketFallback {
  void* context;
  /// Considers primitive `id` for one ray, as Fallback does.
  void (*consider)(void* context, int ray, std::uint32_t id, ClosestSoFar& best);
  /// Considers primitive `id` for all rays of the packet.
  void (*consider_all)(void* context, std::uint32_t id, KernelPacket& packet);
};

/// A multiple of the packet size, but not a power of two, which would put all components of a ray
/// into the same cache set.
inline constexpr int kStreamRays = 31 * kPacketRays;

/// Incoherent rays, stored in one array per component. The caller sets the members above the dashed
/// line for `count` rays, with best_hi = t_max.
struct alignas(64) KernelStream {
  float o[3][kStreamRays], d[3][kStreamRays];
  float t_min[kStreamRays];
  float best_hi[kStreamRays];             ///< as in ClosestSoFar
  std::uint32_t omitted_id[kStreamRays];  ///< as in KernelRay
  int count;
  // ---- set by prepare_stream:
  /// One bit per ray, set if the ray is valid and within KernelRay's limits. Other rays are
  /// replaced by a valid ray, so their results are meaningless.
  std::uint64_t suited[kStreamRays / 64];
  float best_lo[kStreamRays];  ///< as in ClosestSoFar
  std::uint32_t best_id[kStreamRays];
  float near[3][kStreamRays], far[3][kStreamRays];  ///< near_factor and far_factor of each ray
  float t_begin[kStreamRays];                       ///< as in KernelRay
  float d_sum[kStreamRays];                         ///< as in KernelRay
};

/// Whether a masked triangle is visible where a ray hits it.
enum class Visible : std::uint8_t { no, yes, unsure };

/// The barycentric weights of the second and the third vertex of a triangle where a ray hits it.
struct HitWeights {
  static constexpr float kError = 0x1p-17F;

  float second, third;
  bool are_sure;  ///< true if the errors of both are below kError
};

/// Callbacks for hits of a stream's rays that float32 can't decide.
struct StreamFallback {
  void* context;
  void (*consider)(void* context, int ray, std::uint32_t id, ClosestSoFar& best);
  /// Decides for a triangle of TreeView::masked that the ray certainly hits. If the result is
  /// unsure, consider() decides.
  Visible (*visible)(void* context, int ray, std::uint32_t id, const HitWeights& at) = nullptr;
};

inline constexpr std::uint32_t kOtherSlot = 1U << 31U, kIdSlot = ~0U;
inline constexpr int kBoxQueries = 16;

/// Queries for the primitives that touch small closed boxes, and the results. A query omits a
/// triangle, and all triangles in an axis-aligned plane.
struct alignas(64) BoxQueries {
  static constexpr int kMost = 32;

  int size;  ///< number of queries
  float lo[3][kBoxQueries], hi[3][kBoxQueries];
  std::uint32_t omitted_id[kBoxQueries];
  float plane_axis[kBoxQueries];  ///< axis perpendicular to the plane; -1: no plane
  float plane_at[kBoxQueries];    ///< the plane's coordinate on plane_axis
  // ---- set by the kernel:
  int count[kBoxQueries];                   ///< number of results; -1: more than kMost
  std::uint32_t slots[kBoxQueries][kMost];  ///< triangles; or kOtherSlot + index into
                                            ///< TreeView::others; or kIdSlot
  std::uint32_t ids[kBoxQueries][kMost];    ///< primitives of instances, where the slot is kIdSlot
};

/// Bounds of the exact t of the rays of a packet at hits of shapes that float64 filters have found.
struct alignas(64) ShapeBounds {
  double lo[kPacketRays], hi[kPacketRays];
  std::uint32_t id[kPacketRays];  ///< the shape that the bounds belong to, or kNoPrimitive
  float t_max[kPacketRays];       ///< of the rays
};

/// Functions that consider primitive `id` for all rays of a packet, where the shape is given
/// relative to the rays' origin. They return the rays for which the caller must consider it, one
/// bit each.
struct ShapeKernels {
  template <class Seen>
  using Consider = std::uint64_t(const Seen& shape, std::uint32_t id, KernelPacket& packet,
                                 ShapeBounds& found);
  Consider<SeenPlane>* plane;
  Consider<SeenDisc>* disc;
  Consider<SeenSphere>* sphere;
  Consider<SeenQuadric>* quadric;
};

/// The functions of one instruction set.
struct Kernels {
  const char* name;
  ShapeKernels shapes;
  /// Sets `best` to the nearest hit in the tree, if it is nearer than `best`.
  void (*closest)(const TreeView& tree, KernelRay ray, const Fallback& slow, ClosestSoFar& best);
  /// Returns true if there is any hit within the ray's interval.
  bool (*any)(const TreeView& tree, KernelRay ray, const Fallback& slow);
  /// Fills a packet with 2 to kPacketRays rays and no hits. Each ray consists of eight numbers: o,
  /// t_min, d, t_max. The caller has set the packet's order. Returns false if the origins differ,
  /// or if a ray is invalid or exceeds the limits; the packet is then unusable.
  bool (*fill_packet)(const float* rays, int count, KernelPacket& packet);
  /// Does what `closest` does for all rays of a filled packet, but passes through open sides. If
  /// the side is uncertain, `slow` decides.
  void (*closest_of_packet)(const TreeView& tree, KernelPacket& packet, const PacketFallback& slow);
  /// Stores the rays in a stream, whose count the caller has set. Each ray consists of eight
  /// numbers, as for fill_packet().
  void (*read_stream)(const float* rays, KernelStream& stream);
  /// Sets the members of a stream below the dashed line, without hits.
  void (*prepare_stream)(KernelStream& stream);
  /// Does what `closest` does for all rays of a prepared stream, but passes through open sides, for
  /// which `slow` decides if a ray's side is uncertain, and masked triangles that aren't visible.
  void (*closest_of_stream)(const TreeView& tree, KernelStream& stream, const StreamFallback& slow);
  /// Finds any hit within the interval of each ray that has no hit yet, with the same exceptions.
  void (*any_of_stream)(const TreeView& tree, KernelStream& stream, const StreamFallback& slow);
  /// Fills t with the exact parameters rounded to nearest. Returns the set of hits whose t is
  /// certainly right.
  std::uint64_t (*round_t)(HitBatch& hits);
  /// Does the same for the hits of a packet in KernelPacket::hits.
  std::uint64_t (*round_t_of_packet)(const KernelPacket& packet, float* t);
  /// Finds all primitives with a point in each query's box. May return a primitive twice. May also
  /// return triangles of which only the bounding boxes overlap the query's box, and all
  /// non-triangle primitives of a leaf that touches the box.
  void (*touching)(const TreeView& tree, BoxQueries& queries);
  /// Returns the number of triangle edge tests in float64 by this thread.
  std::uint64_t (*edge_tests)();
};

extern const Kernels kPortableKernels;
#if defined(__x86_64__)
extern const Kernels kAvx2Kernels;
extern const Kernels kAvx512Kernels;
#endif

}  // namespace microtrace
