#pragma once
#include "accel/build/float4.hpp"

#include <microtrace/page_allocator.hpp>
#include <microtrace/primitives.hpp>

#include <bit>

namespace microtrace::build {

/// The weight of a primitive is its cost in sixteenths of a block test. Other primitives than
/// triangles are tested one at a time. All triangles of a tree have the same weight: either eight
/// fill a block, or five, if most of them share no vertices.
inline constexpr std::uint32_t kTriangleWeight = 2;
inline constexpr std::uint32_t kUnsharedWeight = 3;
inline constexpr std::uint32_t kOtherWeight = 16;
/// More than a leaf may hold, so instances are never in leaves with other primitives.
inline constexpr std::uint32_t kInstanceWeight = 144;

/// Triangles with a coordinate of larger magnitude are not stored in blocks.
inline constexpr float kLargestInBlocks = 0x1p38F;

/// A reference to a primitive during the build. The fourth lanes of the box hold id and weight. The
/// id of an instance is its index.
struct Reference {
  Box box;

  Reference() = default;
  Reference(const Box& bounds, PrimitiveId id, std::uint32_t weight) : box(bounds) {
    box.lo[3] = std::bit_cast<float>(id);
    box.hi[3] = std::bit_cast<float>(weight);
  }
  [[nodiscard]] PrimitiveId id() const { return std::bit_cast<std::uint32_t>(box.lo[3]); }
  [[nodiscard]] std::uint32_t weight() const { return std::bit_cast<std::uint32_t>(box.hi[3]); }
  [[nodiscard]] bool is_triangle() const { return weight() < kOtherWeight; }
};
static_assert(sizeof(Reference) == 32);

/// Prefetches a reference that a loop over references will reach soon. The processor's own
/// prefetchers don't help at the begin of each of the many small sets.
inline void prefetch_after(const Reference& r) {
  __builtin_prefetch(&r + 32);
}

struct References {
  PageVector<Reference> bounded;
  /// A hash for each bounded reference, equal for triangles with the same vertices.
  PageVector<std::uint32_t> hashes;
  std::vector<PrimitiveId> unbounded;
  std::uint32_t triangle_weight = kTriangleWeight;  ///< or kUnsharedWeight
  double area = 0;  ///< half the surface area of all bounded primitives' boxes
};

/// True if a triangle with this box may be stored in a block.
[[nodiscard]] bool fits_blocks(const Box& box);

[[nodiscard]] inline bool is_point(const Box& box) {
  const Int4 differs = box.lo != box.hi;
  return (differs[0] | differs[1] | differs[2]) == 0;
}

/// Divides the primitives of a scene's objects into bounded and unbounded ones, and omits empty
/// ones. is_instance[i] is true for objects to be left out. Throws Error (limit) if there are more
/// primitives than a tree can address.
[[nodiscard]] References gather(const Primitives& primitives, const std::vector<bool>& is_instance);

/// Gives triangles with three equal vertices the weight of non-triangle primitives. A float32 test
/// can never exclude a hit with such a triangle, so each needs its own box.
void set_points_apart(PageVector<Reference>& references);

}  // namespace microtrace::build
