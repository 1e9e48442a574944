#pragma once
/// Computes the point of a triangle that is nearest to a given point.

#include "exact/numbers/dyadic.hpp"
#include "exact/numbers/ratio.hpp"

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <array>
#include <compare>

namespace microtrace::exact {

struct Nearest {
  std::array<Dyadic, 3> weights;   ///< weights of the triangle's vertices, not negative
  Dyadic total;                    ///< sum of the weights, positive
  Ratio<Dyadic> squared_distance;  ///< a polynomial of degree at most 6 in the coordinates, divided
                                   ///< by one of degree at most 4
};

/// Returns the nearest point to p. All numbers must be finite. The triangle may be degenerate; it
/// is the convex hull of its vertices.
[[nodiscard]] Nearest nearest(const Triangle& triangle, const Vec3& p);

/// Compares two distances exactly.
[[nodiscard]] inline std::strong_ordering compare_distances(const Nearest& x, const Nearest& y) {
  return compare(x.squared_distance, y.squared_distance);
}

/// Returns the distance as float64 with a relative error of at most 2^-48. The result is 0 only if
/// the exact distance is 0.
[[nodiscard]] double distance(const Nearest& nearest);

/// Returns the weights divided by their sum, each with a relative error of at most 2^-48.
[[nodiscard]] DVec3 barycentrics(const Nearest& nearest);

}  // namespace microtrace::exact
