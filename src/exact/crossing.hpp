#pragma once
/// How rays from a point cross triangles, for the parity of crossings.

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

namespace microtrace::exact {

enum class Crossing {
  none,     ///< no common point
  proper,   ///< in one point, which is on no edge
  grazing,  ///< at an edge or a vertex, or within the triangle's plane
  origin,   ///< the ray's origin is in the triangle
};

/// How the ray o + t d, t >= 0, meets a triangle. All numbers must be finite and d not zero.
[[nodiscard]] Crossing crossing(const Triangle& triangle, const Vec3& o, const Vec3& d);

}  // namespace microtrace::exact
