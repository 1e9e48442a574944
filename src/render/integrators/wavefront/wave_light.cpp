/// The light that the paths of a wavefront reach by themselves: emission, environment and ground.

#include "render/integrators/wavefront/wave.hpp"
#include "render/lanes/lane_access.hpp"
#include "render/lights/power_heuristic.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace microtrace {

Vec3 Wave::emission(std::size_t i, const ShadingPoint& point) const {
  if (!point.look->is_emissive() && !point.look->material->unlit) return Vec3(0);
  return shading_->emission(paths_->pdf[i] == 0 ? point : point.unfiltered());
}

void Wave::add_emission(std::size_t i, const Hit& hit, const ShadingPoint& point) {
  const Vec3 emission = this->emission(i, point);
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

void Wave::escape() {
  const bool from_camera = step_.depth == 1;
  std::span escaped = std::span(escaped_).first(std::exchange(escaped_count_, 0));
  const auto is_behind_glass = [&](std::uint32_t i) { return alphas_[paths_->slot[i]] != 0; };
  if (from_camera && ground_) {
    for (const std::uint32_t i : escaped)
      if (!is_behind_glass(i)) meet_ground(i);
  }
  if (!lighting_->has_environment()) return;
  // An environment that is not seen is composited later, but it is part of what glass shows.
  if (from_camera && !lighting_->is_seen())
    escaped = {escaped.begin(), std::partition(escaped.begin(), escaped.end(), is_behind_glass)};
  for (std::size_t first = 0; first < escaped.size(); first += kShadingLanes) {
    const std::size_t count = std::min<std::size_t>(escaped.size() - first, kShadingLanes);
    add_environment(escaped.subspan(first, count));
  }
}

void Wave::add_environment(std::span<const std::uint32_t> escaped) {
  const PathColumns& paths = *paths_;
  const bool from_camera = step_.depth == 1;
  MapLanes<kShadingLanes>& lights = escapes_.lights;
  LightChoices<kShadingLanes>& origins = escapes_.origins;
  for (std::size_t lane = 0; lane < escaped.size(); ++lane) {
    const std::size_t i = escaped[lane];
    for (int axis = 0; axis < 3; ++axis) {
      lights.d[axis][lane] = paths.d[axis][i];
      origins.p[axis][lane] = paths.from_p[axis][i];
      origins.n[axis][lane] = paths.from_n[axis][i];
    }
  }
  lighting_->environment(*kernels_, (Lanes{1} << escaped.size()) - 1, from_camera, escapes_);
  for (std::size_t lane = 0; lane < escaped.size(); ++lane) {
    const std::size_t i = escaped[lane];
    const std::uint32_t slot = paths.slot[i];
    const Vec3 light =
        vector_of(paths.throughput, i) * got(lights.radiance, static_cast<int>(lane));
    if (from_camera) {
      colors_[slot] += light;
      alphas_[slot] = 1;
      continue;
    }
    const float other = paths.is_scattered[i] != 0 ? 0 : lights.pdf[lane];
    colors_[slot] += light * power_heuristic(paths.pdf[i], other);
  }
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
  const float choice = sobol.one(step_.pair(sampling::kLightChoicePair));
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
