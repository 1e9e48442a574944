#pragma once
/// Sampling of emissive spheres, discs and single triangles.

#include "render/lights/light_tree.hpp"

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <optional>

namespace microtrace {

/// Bounds for the light tree, for a radiance of luminance 1. Nothing for shapes that are not
/// sampled, planes and quadrics, and for those without area.
[[nodiscard]] std::optional<LightBounds> shape_bounds(const Shape& shape);

/// A point of a shape as seen from another point.
struct ShapeSample {
  DVec3 to_light{0};  ///< vector to the point
  Vec3 wi{0, 0, 1};   ///< its unit direction
  bool front = true;  ///< whether the front side is visible
  double pdf = 0;     ///< per solid angle
};

/// Samples a shape for which shape_bounds() returns bounds; u in [0, 1)^2. Spheres are sampled
/// uniformly over the subtended solid angle (P. Shirley, C. Wang and K. Zimmerman, Monte Carlo
/// techniques for direct lighting calculations, 1996), if p is outside; other shapes uniformly over
/// their area.
[[nodiscard]] std::optional<ShapeSample> sample_shape(const Shape& shape, const Vec3& p,
                                                      const Vec2& u);

/// The pdf with which sample_shape() returns a point at this distance, whose normal has this
/// cosine, above 0, with the direction. Nonzero only for shapes with bounds.
[[nodiscard]] double shape_pdf(const Shape& shape, const Vec3& p, float distance, float cosine);

}  // namespace microtrace
