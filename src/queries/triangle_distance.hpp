#pragma once
/// The distance from a point to a triangle in float64, with bounds.

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <cstdint>

namespace microtrace {

/// The part of a triangle on which the nearest point lies.
enum class Feature : std::uint8_t { a, b, c, ab, bc, ca, face };

struct TriangleDistance {
  double lo, hi;    ///< bounds of the exact distance
  DVec3 weights;    ///< barycentric coordinates of a point of the triangle that is approximately
                    ///< the nearest
  Feature feature;  ///< of the nearest point
  bool is_certain;  ///< whether `feature` is known to be right
  double position_error;  ///< if so, the maximum distance between this point and the nearest one,
                          ///< without the rounding of its coordinates
  double size;            ///< the largest |component| of the vertices relative to p
};

/// All |coordinates| are at most kLargestCoordinate.
[[nodiscard]] TriangleDistance triangle_distance(const Triangle& triangle, const Vec3& p);

/// True if the nearest points of both triangles are certainly the same vertex or on the same edge,
/// so that their distances are equal.
[[nodiscard]] bool share_feature(const Triangle& s, const TriangleDistance& of_s, const Triangle& t,
                                 const TriangleDistance& of_t);

}  // namespace microtrace
