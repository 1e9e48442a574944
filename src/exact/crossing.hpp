#pragma once
/// Classifies how a ray crosses a triangle, for the inside test of closed surfaces by the parity of
/// crossings.

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

namespace microtrace::exact {

enum class Crossing {
  none,     ///< the ray and the triangle have no common point
  proper,   ///< the ray crosses the triangle at one point, which is not on an edge
  grazing,  ///< the ray meets an edge or a vertex, or lies in the triangle's plane
  origin,   ///< the ray's origin is in the triangle
};

/// Classifies the ray o + t d, t >= 0. All numbers must be finite, and d must not be zero.
[[nodiscard]] Crossing crossing(const Triangle& triangle, const Vec3& o, const Vec3& d);

}  // namespace microtrace::exact
