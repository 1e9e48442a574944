#include "scene/occupied_part.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <variant>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// The least and greatest pixel coordinates of a box.
struct PixelBounds {
  DVec2 least, greatest;
};

/// The extent of the box in the picture. Nothing if a part of the box is beside or behind the
/// camera, where coordinates are imprecise.
std::optional<PixelBounds> pixel_bounds(const DVec3& lo, const DVec3& hi,
                                        const RayGenerator& camera, const DVec3& position) {
  PixelBounds extent{.least = DVec2(std::numeric_limits<double>::infinity()),
                     .greatest = DVec2(-std::numeric_limits<double>::infinity())};
  for (unsigned k = 0; k < 8; ++k) {
    const DVec3 corner((k & 1U) != 0 ? hi.x : lo.x, (k & 2U) != 0 ? hi.y : lo.y,
                       (k & 4U) != 0 ? hi.z : lo.z);
    const auto pixel = camera.project(corner);
    if (!pixel || !(camera.depth(corner) >= glm::distance(corner, position) * 0x1p-10))
      return std::nullopt;
    extent.least = glm::min(extent.least, *pixel);
    extent.greatest = glm::max(extent.greatest, *pixel);
  }
  return extent;
}

}  // namespace

PixelRect occupied_part(const Camera& camera, const RayGenerator& rays, const Vec3& lo,
                        const Vec3& hi, const PixelRect& window) {
  if (!std::holds_alternative<PerspectiveCamera>(camera)) return window;
  const CameraModel model = rays.model();
  const DVec3 position(model.world_from_camera[3]);

  // Because of rounding to float32, a ray's direction differs from the direction to its pixel
  // center. For directions scaled to depth 1, which have the length L, the difference is less than
  // 2^-23 L. It moves the intersection with the plane at depth 1 by less than L^2 2^-21.
  const DVec2 reach = glm::max(glm::abs(DVec2(window.x0, window.y0) - model.center),
                               glm::abs(DVec2(window.x1, window.y1) - model.center)) /
                      model.pixels_per_unit;
  const double square = 1 + glm::dot(reach, reach);
  const bool is_precise = square <= 0x1p20 && square * 0x1p-21 * model.pixels_per_unit.x <= 0.25;
  if (!is_precise) return window;

  // Rounding also moves the ray's origin. Enlarging the box by the same amount allows for this.
  const DVec3 moved = glm::abs(DVec3(Vec3(position)) - position) + glm::abs(position) * 0x1p-50;
  const auto extent = pixel_bounds(DVec3(lo) - moved, DVec3(hi) + moved, rays, position);
  if (!extent) return window;

  // Centers of pixels outside the result are more than one pixel away from the extent.
  const auto limited = [](double x, std::uint32_t first, std::uint32_t last) {
    return static_cast<std::uint32_t>(std::clamp(x, double{1} * first, double{1} * last));
  };
  return {.x0 = limited(std::floor(extent->least.x) - 1, window.x0, window.x1),
          .y0 = limited(std::floor(extent->least.y) - 1, window.y0, window.y1),
          .x1 = limited(std::ceil(extent->greatest.x) + 1, window.x0, window.x1),
          .y1 = limited(std::ceil(extent->greatest.y) + 1, window.y0, window.y1)};
}

}  // namespace microtrace
