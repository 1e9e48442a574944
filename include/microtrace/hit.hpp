#pragma once
/// What a ray met.

#include <cstdint>

namespace microtrace {

/// Numbers the primitives of a scene in the order of its file: a shape of its own takes one number,
/// a mesh one for each of its triangles. Of two hits at the same t the lower number wins.
using PrimitiveId = std::uint32_t;

struct Hit {
  PrimitiveId id = 0;
  float t = 0;  ///< the exact parameter, rounded once to the nearest float32 (ties to even)
};

}  // namespace microtrace
