#pragma once
/// Sampling of emissive spheres, discs and single triangles.

#include "render/lights/light_tree.hpp"

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <optional>

namespace microtrace {

/// Bounds for the light tree, for a luminance of 1. Nothing for planes, quadrics and shapes without
/// area, which are not sampled.
[[nodiscard]] std::optional<LightBounds> shape_bounds(const Shape& shape);

[[nodiscard]] double triangle_area(const Triangle& t);

/// A point of a shape as seen from another point.
struct ShapeSample {
  DVec3 to_light{0};  ///< vector to the point
  Vec3 wi{0, 0, 1};   ///< its unit direction
  bool front = true;  ///< whether the front side is visible
  double pdf = 0;     ///< per solid angle
};

/// Samples a shape for which shape_bounds() returns bounds; u in [0, 1)^2. A sphere is sampled
/// uniformly over the solid angle that it subtends if p is outside (P. Shirley, C. Wang and K.
/// Zimmerman, Monte Carlo techniques for direct lighting calculations, 1996). Other shapes are
/// sampled uniformly by area.
[[nodiscard]] std::optional<ShapeSample> sample_shape(const Shape& shape, const Vec3& p,
                                                      const Vec2& u);

/// The pdf with which sample_shape() returns a point at this distance. `cosine`, above 0, is that
/// of the angle between the direction and the normal at the point. Nonzero only for shapes with
/// bounds.
[[nodiscard]] double shape_pdf(const Shape& shape, const Vec3& p, float distance, float cosine);

}  // namespace microtrace
