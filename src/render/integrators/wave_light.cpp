/// The light that the paths of a wavefront reach by themselves: emission, environment and ground.

#include "render/integrators/power_heuristic.hpp"
#include "render/integrators/wave.hpp"

#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace {

void Wave::add_emission(std::size_t i, const Hit& hit, const ShadingPoint& point) {
  const Vec3 emission = shading_->emission(point);
  if (emission == Vec3(0)) return;
  const PathColumns& paths = *paths_;
  float weight = 1;
  if (const float pdf = paths.pdf[i]; pdf > 0 && paths.is_scattered[i] == 0) {
    const float cosine = std::abs(glm::dot(unit<1>(vector_of(paths.d, i)), point.at.n));
    weight = power_heuristic(
        pdf, lighting_->emitter_pdf(hit.id, paths.from(i), point.at.distance, cosine));
  }
  colors_[paths.slot[i]] += vector_of(paths.throughput, i) * emission * weight;
}

void Wave::escape(std::size_t i) {
  const PathColumns& paths = *paths_;
  const Vec3 wi = unit<1>(vector_of(paths.d, i));
  const std::uint32_t slot = paths.slot[i];
  if (const float pdf = paths.pdf[i]; pdf > 0) {
    const EnvironmentLight::Lookup light = lighting_->environment(paths.from(i), wi);
    const float other = paths.is_scattered[i] != 0 ? 0 : light.pdf;
    colors_[slot] += vector_of(paths.throughput, i) * light.radiance * power_heuristic(pdf, other);
  } else if (lighting_->is_seen()) {  // otherwise the background is composited later
    colors_[slot] += vector_of(paths.throughput, i) * lighting_->environment(wi);
    alphas_[slot] = 1;
  }
  if (ground_ && paths.pdf[i] == 0) meet_ground(i);
}

std::optional<float> Wave::find_ground() const {
  if (!options_.ground) return std::nullopt;
  if (const std::optional<double>& height = options_.ground->height)
    return static_cast<float>(*height - world_->scene.origin.y);
  const std::optional<double>& lowest = lighting_->ground(world_->scene).lowest();
  return lowest ? std::optional(static_cast<float>(*lowest)) : std::nullopt;
}

void Wave::meet_ground(std::size_t i) {
  const std::optional<Vec3> p = point_on_ground(paths_->ray(i), *ground_);
  if (!p) return;
  const sampling::Sobol sobol = paths_->sobol(i);
  const float choice = sobol.pair(step_.pair(sampling::kLightChoicePair)).x;
  const Vec2 u = sobol.pair(step_.pair(sampling::kLightPair));
  if (const auto light = lighting_->ground(world_->scene).sample(*p, choice, u))
    ground_shadows_.add(*p, light->to_light, light->is_far, paths_->slot[i]);
}

void Wave::darken(std::size_t slot, float occlusion) {
  if (lighting_->is_seen())
    colors_[slot] *= 1 - occlusion;
  else
    alphas_[slot] = occlusion;
}

}  // namespace microtrace
