#pragma once
/// Finds the part of a picture that a box can cover.

#include <microtrace/camera.hpp>
#include <microtrace/math.hpp>

namespace microtrace {

/// Returns a part of the window outside which no ray through a pixel center hits anything in the
/// box from `lo` to `hi`. It may be empty, with x0 >= x1 or y0 >= y1. It is the whole window unless
/// a perspective camera looks at the box from outside. `rays` must be the camera's rays.
[[nodiscard]] PixelRect occupied_part(const Camera& camera, const RayGenerator& rays,
                                      const Vec3& lo, const Vec3& hi, const PixelRect& window);

/// True if two rectangles overlap. Empty rectangles overlap nothing.
[[nodiscard]] inline bool overlap(const PixelRect& a, const PixelRect& b) {
  return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1 && b.x0 < b.x1 && b.y0 < b.y1;
}

}  // namespace microtrace
