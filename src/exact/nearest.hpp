#pragma once
/// The point of a triangle that is nearest to a given point.

#include "exact/numbers/dyadic.hpp"
#include "exact/numbers/ratio.hpp"

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <array>
#include <compare>

namespace microtrace::exact {

struct Nearest {
  std::array<Dyadic, 3> weights;   ///< of the triangle's vertices, not negative
  Dyadic total;                    ///< sum of the weights, positive
  Ratio<Dyadic> squared_distance;  ///< a form of degree 6 at most, divided by one of degree 4 at
                                   ///< most
};

/// All numbers must be finite. A triangle is the convex hull of its vertices, which may be equal.
[[nodiscard]] Nearest nearest(const Triangle& triangle, const Vec3& p);

/// The order of the distances.
[[nodiscard]] inline std::strong_ordering compare_distances(const Nearest& x, const Nearest& y) {
  return compare(x.squared_distance, y.squared_distance);
}

/// The distance rounded to float64, with a relative error of at most 2^-48. It is 0 only if the
/// exact distance is 0.
[[nodiscard]] double distance(const Nearest& nearest);

/// The weights divided by their sum, each with the same error bound.
[[nodiscard]] DVec3 barycentrics(const Nearest& nearest);

}  // namespace microtrace::exact
