#pragma once
/// Classifies how a ray from a point crosses a triangle, to count crossings.

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

namespace microtrace::exact {

enum class Crossing {
  none,     ///< the ray and the triangle have no common point
  proper,   ///< the ray crosses at one point that is on no edge
  grazing,  ///< the ray meets an edge or a vertex, or runs within the triangle's plane
  origin,   ///< the ray's origin is in the triangle
};

/// Classifies the ray o + t d, t >= 0. All numbers must be finite, and d must not be zero.
[[nodiscard]] Crossing crossing(const Triangle& triangle, const Vec3& o, const Vec3& d);

}  // namespace microtrace::exact
