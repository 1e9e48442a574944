#include "render/aovs/lamp_pixels.hpp"

#include "scene/material_textures.hpp"
#include "scene/support.hpp"
#include "scene/translation_to_origin.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

namespace microtrace {
namespace {

/// A rectangle of pixel coordinates; empty if low > high.
struct Part {
  DVec2 low{std::numeric_limits<double>::infinity()};
  DVec2 high{-std::numeric_limits<double>::infinity()};
};

constexpr Part kEverywhere{.low = DVec2(-std::numeric_limits<double>::infinity()),
                           .high = DVec2(std::numeric_limits<double>::infinity())};

/// Surfaces with a texture are left out, since they are often models with few luminous parts, which
/// would take too much time.
bool is_lamp(const Material& material) {
  return is_emissive(material) && !material.emissive_texture;
}

/// Returns a part that contains the projection of the shape. The camera must be a pinhole with a
/// perspective projection, which maps the corners of a box to points around its picture.
Part part_of(const PlacedShape& shape, const RayGenerator& camera, ChunkedMeshes& chunks) {
  const std::optional<Extent> box =
      std::holds_alternative<Plane>(shape.shape) ? std::nullopt : extent_of(shape, chunks);
  if (!box) return kEverywhere;
  Part part;
  int in_front = 0;
  for (const DVec3& corner : corners_of(PointBounds{.low = box->low, .high = box->high})) {
    const std::optional<DVec2> pixel = camera.project(corner);
    if (!pixel) continue;
    ++in_front;
    part.low = glm::min(part.low, *pixel);
    part.high = glm::max(part.high, *pixel);
  }
  return in_front == 0 || in_front == 8 ? part : kEverywhere;
}

}  // namespace

LampPixels::LampPixels(const Scene& scene, const RayGenerator& camera, const PixelRect& window)
    : window_(window) {
  const std::uint32_t width = window.size().width, height = window.size().height;
  const bool is_pinhole =
      !camera.has_lens() && camera.frustum(window.x0, window.y0, window.x0 + 1, window.y0 + 1);
  // The number of parts that contain a pixel is the sum of the differences above and left of it.
  const std::size_t columns = std::size_t{width} + 1;
  std::vector<std::int32_t> differences(columns * (height + 1));
  const auto begin_of = [](double low, std::uint32_t first, std::uint32_t size) {
    return static_cast<std::size_t>(std::clamp<double>(std::floor(low) - first, 0, size));
  };
  ChunkedMeshes chunks;
  const auto add = [&](const Part& part) {
    // A sample is at most 1.5 pixels from the middle of its pixel.
    constexpr double kReach = 2;
    const std::size_t x0 = begin_of(part.low.x - kReach, window.x0, width),
                      y0 = begin_of(part.low.y - kReach, window.y0, height),
                      x1 = begin_of(part.high.x + kReach + 1, window.x0, width),
                      y1 = begin_of(part.high.y + kReach + 1, window.y0, height);
    if (x0 >= x1 || y0 >= y1) return;
    ++differences[y0 * columns + x0];
    --differences[y0 * columns + x1];
    --differences[y1 * columns + x0];
    ++differences[y1 * columns + x1];
  };
  for (const ObjectRun& run : scene.objects.runs()) {
    if (!is_lamp(material_of(scene, *run.first))) continue;
    for (std::size_t i = 0; i < run.count; ++i)
      add(is_pinhole ? part_of({run, i}, camera, chunks) : kEverywhere);
  }
  is_in_.resize(std::size_t{width} * height);
  std::vector<std::int32_t> above(columns);
  for (std::size_t y = 0; y < height; ++y) {
    std::int32_t left = 0;
    for (std::size_t x = 0; x < width; ++x) {
      above[x] += differences[y * columns + x];
      left += above[x];
      is_in_[y * width + x] = left > 0;
    }
  }
}

}  // namespace microtrace
