#include "render/lighting/ground_light.hpp"

#include "render/lights/punctual.hpp"
#include "scene/math/luminance.hpp"
#include "scene/support.hpp"

#include <algorithm>
#include <numbers>

namespace microtrace {
namespace {

/// Returns the luminance of the irradiance on a horizontal surface.
double irradiance(const FoundLight& light) {
  return luminance(light.light) * std::max(double{light.wi.y}, 0.0);
}

}  // namespace

GroundLight::GroundLight(const Scene& scene, const EnvironmentLight* environment) : scene_(scene) {
  ChunkedMeshes chunks;
  for (const ObjectRun& run : scene.objects.runs()) {
    for (std::size_t i = 0; i < run.count; ++i) {
      const std::optional<Extent> extent = extent_of({run, i}, chunks);
      if (extent && (!lowest_ || extent->low.y < *lowest_)) lowest_ = extent->low.y;
    }
  }
  if (environment != nullptr) sky_.emplace(*environment);
}

std::optional<GroundLight::Sample> GroundLight::sample(const Vec3& p, float choice,
                                                       const Vec2& u) const {
  const double sky = sky_ ? std::numbers::pi * sky_->irradiance() : 0;
  double total = sky;
  for (const NamedLight& light : scene_.lights) {
    if (const auto found = of_punctual(punctual_light(light.light), p)) total += irradiance(*found);
  }
  if (!(total > 0)) return std::nullopt;
  const double target = double{choice} * total;
  if (target < sky) return Sample{.to_light = sky_->sample(u), .is_far = true};
  double sum = sky;
  for (const NamedLight& light : scene_.lights) {
    const auto found = of_punctual(punctual_light(light.light), p);
    if (!found) continue;
    sum += irradiance(*found);
    if (target < sum) return Sample{.to_light = Vec3(found->to_light), .is_far = found->is_far};
  }
  return std::nullopt;
}

}  // namespace microtrace
