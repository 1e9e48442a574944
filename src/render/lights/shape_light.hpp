#pragma once
/// Spheres, discs and triangles outside meshes that shine: where on them to look for light.

#include "render/lights/light_tree.hpp"

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <optional>

namespace microtrace {

/// To choose among several, for a radiance of luminance 1. Nothing for shapes that are not sampled,
/// planes and quadrics, and for those without area.
[[nodiscard]] std::optional<LightBounds> shape_bounds(const Shape& shape);

/// A point of a shape as another point sees it.
struct ShapeSample {
  DVec3 way{0};        ///< to it
  Vec3 wi{0, 0, 1};    ///< its direction, of unit length
  bool front = true;   ///< whether the front side is seen
  double density = 0;  ///< per solid angle
};

/// Of a shape that has bounds; u in [0, 1)^2. Spheres are sampled evenly over the solid angle under
/// which they are seen (P. Shirley, C. Wang and K. Zimmerman, Monte Carlo techniques for direct
/// lighting calculations, 1996), from outside; others evenly over their area.
[[nodiscard]] std::optional<ShapeSample> sample_shape(const Shape& shape, const Vec3& p,
                                                      const Vec2& u);

/// The density with which sample_shape() gives a point at that distance, where the shape's normal
/// has that cosine with the way, above 0. Not 0 for shapes that have bounds alone.
[[nodiscard]] double shape_density(const Shape& shape, const Vec3& p, float distance, float cosine);

}  // namespace microtrace
