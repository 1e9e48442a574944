#pragma once
#include "accel/build/float4.hpp"
#include "accel/build/page_allocator.hpp"

#include <microtrace/primitives.hpp>

#include <bit>

namespace microtrace::build {

/// Work is counted in eighths of a block of triangles: one for a triangle; all eight for any other
/// primitive, which is tested alone.
inline constexpr std::uint32_t kTriangleWeight = 1;
inline constexpr std::uint32_t kOtherWeight = 8;

/// Triangles with a larger coordinate do not go into blocks.
inline constexpr float kLargestInBlocks = 0x1p38F;

/// A primitive on its way into a leaf: its box, with the number and the weight in the fourth lanes.
struct Reference {
  Box box;

  Reference() = default;
  Reference(const Box& bounds, PrimitiveId id, std::uint32_t weight) : box(bounds) {
    box.lo[3] = std::bit_cast<float>(id);
    box.hi[3] = std::bit_cast<float>(weight);
  }
  [[nodiscard]] PrimitiveId id() const { return std::bit_cast<std::uint32_t>(box.lo[3]); }
  [[nodiscard]] std::uint32_t weight() const { return std::bit_cast<std::uint32_t>(box.hi[3]); }
};
static_assert(sizeof(Reference) == 32);

struct References {
  PageVector<Reference> bounded;
  /// A number for each of these, the same for triangles with the same corners.
  PageVector<std::uint32_t> hashes;
  std::vector<PrimitiveId> unbounded;
};

/// Sorts a scene's primitives into those with a finite box, those without, and those without a
/// point, which are left out. Throws Error (limit) if there are more than one tree can hold.
[[nodiscard]] References gather(const Primitives& primitives);

/// Gives triangles whose corners are one point the weight of other primitives: float32 can't tell
/// that a ray misses them, so they need boxes of their own.
void set_points_apart(PageVector<Reference>& references);

}  // namespace microtrace::build
