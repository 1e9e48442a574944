#pragma once
/// Computes the distance from a point to a triangle in float64, with error bounds.

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <cstdint>

namespace microtrace {

/// The vertex, edge or face of a triangle on which the nearest point lies.
enum class Feature : std::uint8_t { a, b, c, ab, bc, ca, face };

struct TriangleDistance {
  double lo, hi;    ///< bounds of the exact distance
  DVec3 weights;    ///< barycentric coordinates of a point that approximates the nearest point
  Feature feature;  ///< the feature on which the nearest point lies
  bool is_certain;  ///< true if `feature` is certainly right
  double position_error;  ///< if is_certain, the maximum distance between the point at `weights`
                          ///< and the nearest point, without the rounding of coordinates
  double size;            ///< the largest |component| of the vertices relative to p
};

/// Returns the distance from p. All |coordinates| must be at most kLargestCoordinate.
[[nodiscard]] TriangleDistance triangle_distance(const Triangle& triangle, const Vec3& p);

/// Returns true if the nearest points of two triangles are certainly the same vertex or on the same
/// edge, which implies equal distances.
[[nodiscard]] bool share_feature(const Triangle& s, const TriangleDistance& of_s, const Triangle& t,
                                 const TriangleDistance& of_t);

}  // namespace microtrace
