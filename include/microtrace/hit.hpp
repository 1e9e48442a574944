#pragma once
/// The result of an intersection query.

#include <cstdint>

namespace microtrace {

/// The number of a primitive. Numbers follow file order: a shape has one number, and a mesh has one
/// for each triangle. Of two hits at the same t, the one with the lower number counts as nearer.
using PrimitiveId = std::uint32_t;

/// Stands for no primitive.
inline constexpr PrimitiveId kNoPrimitive = ~PrimitiveId{0};

struct Hit {
  PrimitiveId id = 0;
  float t = 0;  ///< the exact ray parameter, rounded once to the nearest float32 (ties to even)
};

}  // namespace microtrace
