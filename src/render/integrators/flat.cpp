#include "render/surfaces.hpp"

#include <microtrace/integrator.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

namespace microtrace {
namespace {

/// Compositing stops below this remaining transparency, because smaller contributions could not
/// change a float32.
constexpr double kLeastLight = 0x1p-25;

/// The hits at the current depth. They are collected so that a surface counts only once if several
/// of its triangles share the hit point.
class Depth {
 public:
  explicit Depth(const World& world, const Ray& ray) : surfaces_(world.surfaces), ray_(ray) {}

  /// True if no hit at this depth is on the same surface. Hits must be passed in order.
  bool is_new(const Hit& hit) {
    if (count_ > 0 && hits_[0].t != hit.t) count_ = 0;
    const auto known = std::span(hits_).first(count_);
    const bool result = std::ranges::none_of(
        known, [&](const Hit& other) { return surfaces_.is_same_point(ray_, other, hit); });
    if (count_ < hits_.size()) hits_[count_++] = hit;
    return result;
  }

 private:
  const Surfaces& surfaces_;
  const Ray& ray_;
  std::array<Hit, 16> hits_;
  std::size_t count_ = 0;
};

/// Composites the surfaces along the ray, starting at `first`, each over the surfaces behind it (T.
/// Porter and T. Duff, Compositing digital images, 1984).
Sample composite(const World& world, const Ray& ray, const Hit& first) {
  std::optional<Hit> hit = first;
  DVec3 color(0);
  double through = 1;  // transparency of the surfaces composited so far
  Depth depth(world, ray);
  while (hit) {
    if (depth.is_new(*hit)) {
      const Vec4 surface = world.base_color(ray, *hit);
      const double alpha = surface.w;
      if (alpha > 0) color += through * alpha * DVec3(surface);
      through *= 1 - alpha;
      if (through < kLeastLight) break;
    }
    hit = world.bvh.next(ray, *hit);
  }
  return {.color = Vec3(color), .alpha = static_cast<float>(1 - through)};
}

}  // namespace

void FlatIntegrator::trace(const World& world, std::span<const Ray> rays,
                           std::span<const SampleId> /*ids*/, std::span<Sample> samples) const {
  std::array<std::optional<Hit>, kMaxBatch> hits;
  world.bvh.intersect(rays, std::span(hits).first(rays.size()));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    samples[i] = Sample{};
    if (!hits[i]) continue;
    if (const Vec3* color = world.surfaces.plain_color(rays[i], *hits[i])) {
      samples[i] = {.color = *color, .alpha = 1};
    } else {
      samples[i] = composite(world, rays[i], *hits[i]);
    }
  }
}

}  // namespace microtrace
