#include "accel/intersect_fronts.hpp"
#include "render/shading/compositing.hpp"
#include "render/shading/surfaces.hpp"

#include <microtrace/integrator.hpp>

#include <array>
#include <cstddef>
#include <optional>

namespace microtrace {
namespace {

/// Composites the surfaces along the ray, starting at `first`.
Sample composite(const World& world, const Ray& ray, const Hit& first) {
  Compositing surfaces(world, ray);
  for (std::optional<Hit> hit = first; hit; hit = world.bvh.next(ray, *hit)) {
    surfaces.add(*hit);
    if (surfaces.is_opaque()) break;
  }
  return surfaces.sample();
}

}  // namespace

void FlatIntegrator::trace(const World& world, std::span<const Ray> rays,
                           std::span<const SampleId> /*ids*/, std::span<Sample> samples) const {
  std::array<std::optional<Hit>, kRegularBatch> hits;
  intersect_fronts(world.bvh, rays, world.open_backs, std::span(hits).first(rays.size()));
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

std::optional<Sample> FlatIntegrator::common_sample(const World& world,
                                                    const Frustum& frustum) const {
  const CommonHit hit = world.bvh.common_hit(frustum);
  if (!hit.is_known) return std::nullopt;
  if (!hit.id) return Sample{};
  const Vec3* const color = world.surfaces.plain_color(*hit.id);
  if (color == nullptr) return std::nullopt;
  return Sample{.color = *color, .alpha = 1};
}

}  // namespace microtrace
