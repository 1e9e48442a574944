#include "dataset/annotations/overlaps.hpp"

#include "scene/occupied_part.hpp"
#include "scene/support.hpp"

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <limits>
#include <variant>

#include <glm/common.hpp>

namespace microtrace::dataset {
namespace {

PixelRect part_of(const Mesh& mesh, const Camera& camera, const RayGenerator& rays,
                  const PixelRect& window) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Vec3 lo(kInfinity), hi(-kInfinity);
  for (const Vec3& position : mesh.positions) {
    lo = glm::min(lo, position);
    hi = glm::max(hi, position);
  }
  if (!(lo.x <= hi.x)) return {};  // no vertices
  return occupied_part(camera, rays, lo, hi, window);
}

}  // namespace

std::vector<PixelRect> parts_of_objects(const Scene& scene, const Camera& camera,
                                        const RayGenerator& rays, const PixelRect& window) {
  std::vector<PixelRect> parts;
  parts.reserve(scene.objects.size());
  ChunkedMeshes chunks;
  const auto part = [&](const ObjectRun& run, std::size_t i) {
    const auto* mesh = std::get_if<Mesh>(&run.first->shape);
    if (mesh == nullptr) return window;
    if (run.mesh(i).placement == nullptr) return part_of(*mesh, camera, rays, window);
    const std::optional<Extent> extent = extent_of({run, i}, chunks);
    if (!extent) return PixelRect{};
    return occupied_part(camera, rays, Vec3(extent->low), Vec3(extent->high), window);
  };
  for (const ObjectRun& run : scene.objects.runs())
    for (std::size_t i = 0; i < run.count; ++i) parts.push_back(part(run, i));
  return parts;
}

Overlaps::Overlaps(const std::vector<PixelRect>& parts, const PixelRect& window)
    : window_(window),
      width_(window.x1 - window.x0),
      counts_((std::size_t{width_} + 1) * (window.y1 - window.y0 + 1)) {
  // Each part adds 1 at its upper left corner. Sums over rows and columns then count the parts.
  const auto at = [&](std::uint32_t x, std::uint32_t y) -> std::uint32_t& {
    return counts_[std::size_t{y - window_.y0} * (width_ + 1) + (x - window_.x0)];
  };
  for (const PixelRect& part : parts) {
    const std::uint32_t x0 = std::max(part.x0, window.x0), x1 = std::min(part.x1, window.x1);
    const std::uint32_t y0 = std::max(part.y0, window.y0), y1 = std::min(part.y1, window.y1);
    if (x0 >= x1 || y0 >= y1) continue;
    ++at(x0, y0);
    --at(x1, y0);
    --at(x0, y1);
    ++at(x1, y1);
  }
  for (std::uint32_t y = window.y0; y < window.y1; ++y) {
    for (std::uint32_t x = window.x0; x < window.x1; ++x) {
      if (x > window.x0) at(x, y) += at(x - 1, y);
    }
  }
  for (std::uint32_t y = window.y0 + 1; y < window.y1; ++y) {
    for (std::uint32_t x = window.x0; x < window.x1; ++x) at(x, y) += at(x, y - 1);
  }
  several_ = {.x0 = window.x1, .y0 = window.y1, .x1 = window.x0, .y1 = window.y0};
  for (std::uint32_t y = window.y0; y < window.y1; ++y) {
    for (std::uint32_t x = window.x0; x < window.x1; ++x) {
      if (at(x, y) < 2) continue;
      several_ = {.x0 = std::min(several_.x0, x),
                  .y0 = std::min(several_.y0, y),
                  .x1 = std::max(several_.x1, x + 1),
                  .y1 = y + 1};
    }
  }
}

}  // namespace microtrace::dataset
