#pragma once
/// The result of an intersection query.

#include <cstdint>

namespace microtrace {

/// The number of a primitive, in file order: a shape has one number, a mesh one for each triangle.
/// Of two hits at the same t the lower number is the nearer one.
using PrimitiveId = std::uint32_t;

struct Hit {
  PrimitiveId id = 0;
  float t = 0;  ///< the exact parameter, rounded once to the nearest float32 (ties to even)
};

}  // namespace microtrace
