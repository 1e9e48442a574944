#pragma once
/// Samples emissive spheres, discs and single triangles.

#include "render/lights/light_tree.hpp"

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <optional>

namespace microtrace {

/// Bounds for the light tree, for an emitted luminance of 1. Nothing for planes, quadrics and
/// shapes without area, which are not sampled.
[[nodiscard]] std::optional<LightBounds> shape_bounds(const Shape& shape);

[[nodiscard]] double triangle_area(const Triangle& t);

/// A point on a shape as seen from another point.
struct ShapeSample {
  DVec3 to_light{0};  ///< vector to the point
  Vec3 wi{0, 0, 1};   ///< unit direction of to_light
  bool front = true;  ///< true if the front side is visible
  double pdf = 0;     ///< per solid angle
};

/// Samples a shape for which shape_bounds() returns bounds. u is in [0, 1)^2. If p is outside a
/// sphere, the sphere is sampled uniformly over the solid angle that it subtends (P. Shirley, C.
/// Wang and K. Zimmerman, Monte Carlo techniques for direct lighting calculations, 1996). Other
/// shapes are sampled uniformly by area.
[[nodiscard]] std::optional<ShapeSample> sample_shape(const Shape& shape, const Vec3& p,
                                                      const Vec2& u);

/// The pdf with which sample_shape() returns a point at this distance. `cosine` is the cosine of
/// the angle between the direction and the normal at the point; it must be positive. The pdf is 0
/// for shapes without bounds.
[[nodiscard]] double shape_pdf(const Shape& shape, const Vec3& p, float distance, float cosine);

}  // namespace microtrace
