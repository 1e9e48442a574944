#include "exact/triangle_box.hpp"

#include "exact/numbers/vector.hpp"
#include "exact/queries.hpp"

#include <array>

namespace microtrace::exact {
namespace {

Vector unit_vector(int axis) {
  return {axis == 0 ? 1.0F : 0.0F, axis == 1 ? 1.0F : 0.0F, axis == 2 ? 1.0F : 0.0F};
}

/// True if the projections onto the axis have no point in common. Never for a zero axis.
bool separates(const Vector& axis, const std::array<Vector, 3>& corners, const Vector& lo,
               const Vector& hi) {
  Dyadic least = 0.0F, greatest = 0.0F;  // of the box
  for (int k = 0; k < 3; ++k) {
    const bool ascends = axis[k].sign() >= 0;
    least = least + axis[k] * (ascends ? lo : hi)[k];
    greatest = greatest + axis[k] * (ascends ? hi : lo)[k];
  }
  bool are_below = true, are_above = true;
  for (const Vector& corner : corners) {
    const Dyadic at = dot(axis, corner);
    are_below = are_below && compare(at, least) < 0;
    are_above = are_above && compare(greatest, at) < 0;
  }
  return are_below || are_above;
}

}  // namespace

// Two convex polytopes without a common point are separated along a face normal of one of them or
// the cross product of two edges (S. Gottschalk, "Separating axis theorem", 1996). For a segment or
// a point, the same axes include those that are needed.
bool meets_box(const Triangle& triangle, const Vec3& lo, const Vec3& hi) {
  ++queries.dyadic;
  const std::array<Vector, 3> corners{vector(triangle.a), vector(triangle.b), vector(triangle.c)};
  const std::array<Vector, 3> edges{corners[1] - corners[0], corners[2] - corners[1],
                                    corners[0] - corners[2]};
  const Vector least = vector(lo), greatest = vector(hi);
  const auto is_apart = [&](const Vector& axis) {
    return separates(axis, corners, least, greatest);
  };
  if (is_apart(cross(edges[0], edges[1]))) return false;
  for (int k = 0; k < 3; ++k) {
    const Vector axis = unit_vector(k);
    if (is_apart(axis)) return false;
    for (const Vector& edge : edges)
      if (is_apart(cross(axis, edge))) return false;
  }
  return true;
}

}  // namespace microtrace::exact
