#pragma once
#include "accel/build/float4.hpp"

#include <microtrace/hit.hpp>

#include <bit>

namespace microtrace::build {

/// The weight of a primitive is its cost in sixteenths of a block test. Primitives other than
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
/// prefetchers don't help at the start of each of the many small sets.
inline void prefetch_after(const Reference& r) {
  __builtin_prefetch(&r + 32);
}

/// True if a triangle with this box may be stored in a block.
[[nodiscard]] inline bool fits_blocks(const Box& b) {
  const Float4 size = max(max(b.hi, -b.hi), max(b.lo, -b.lo));
  return size[0] <= kLargestInBlocks && size[1] <= kLargestInBlocks && size[2] <= kLargestInBlocks;
}

[[nodiscard]] inline bool is_point(const Box& box) {
  const Int4 differs = box.lo != box.hi;
  return (differs[0] | differs[1] | differs[2]) == 0;
}

/// Returns half of a box's centroid, which orders boxes like their centroids and always stays
/// finite.
[[nodiscard]] inline Float4 centroid(const Box& b) {
  return xyz(b.lo) * splat(0.25F) + xyz(b.hi) * splat(0.25F);
}

}  // namespace microtrace::build
