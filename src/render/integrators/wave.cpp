#include "render/integrators/wave.hpp"

#include "scene/exponential.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// Paths at least this long end at random if they carry little.
constexpr std::uint32_t kFirstRoulette = 4;

/// E. Veach, Robust Monte Carlo methods for light transport simulation, 1997, section 9.2.2.
float power_heuristic(float density, float other) {
  const float square = density * density;
  return square / (square + other * other);
}

/// Whether a direction is on one side of the surface, that of the ray if `above`, by the geometric
/// normal as it is by the shading normal.
bool agrees(const ShadingPoint& point, const Vec3& wi, bool above) {
  const float cosine = glm::dot(wi, point.at.n);
  return point.at.front == above ? cosine > 0 : cosine < 0;
}

/// Of light after a way through a medium.
Vec3 transmittance(const Vec3& absorption, float distance) {
  Vec3 left(1);
  for (int c = 0; c < 3; ++c) {
    const double powers = double{absorption[c]} * distance;
    if (powers > 0) left[c] = static_cast<float>(power_of_two(-std::min(powers, 200.0)));
  }
  return left;
}

}  // namespace

void Wave::begin(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids) {
  world_ = &world;
  shading_ = world.shading;
  lighting_ = world.lighting;
  sample_width_ = 1 / std::sqrt(static_cast<float>(world.samples));
  count_ = rays.size();
  depth_ = 1;
  for (std::size_t i = 0; i < count_; ++i) {
    rays_[i] = rays[i];
    paths_[i] = {.sobol = sampling::Sobol(ids[i].key, ids[i].index), .slot = i};
    colors_[i] = Vec3(0);
    alphas_[i] = 0;
  }
}

void Wave::trace(const World& world, const PathOptions& options, std::span<const Ray> rays,
                 std::span<const SampleId> ids, std::span<Sample> samples) {
  begin(world, rays, ids);
  max_depth_ = options.max_depth;
  for (; count_ > 0; ++depth_) {
    world_->bvh.intersect(std::span(rays_).first(count_), std::span(hits_).first(count_));
    for (std::size_t i = 0; i < count_; ++i) step(i);
    set_off();
    shadow_rays_.arrive(world_->bvh, *shading_, colors_);
  }
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = {.color = colors_[i], .alpha = alphas_[i]};
}

void Wave::set_off() {
  world_->bvh.spawn_origins(std::span(spawns_).first(spawn_count_),
                            std::span(origins_).first(spawn_count_));
  // Without an origin there is no room between two walls.
  for (const Shadow& shadow : std::span(shadows_).first(shadow_count_)) {
    if (const auto& origin = origins_[shadow.spawn])
      shadow_rays_.add(*origin, shadow.light, shadow.color, shadow.slot);
  }
  count_ = 0;
  for (const Onward& onward : std::span(onwards_).first(onward_count_)) {
    const auto& origin = origins_[onward.spawn];
    if (!origin) continue;
    rays_[count_] = {.o = *origin, .t_min = 0, .d = spawns_[onward.spawn].direction};
    paths_[count_++] = onward.path;
  }
  shadow_count_ = onward_count_ = spawn_count_ = 0;
}

void Wave::escape(const Ray& ray, const PathState& path) {
  const Vec3 wi = bsdf::unit(ray.d);
  if (path.density > 0) {
    const float weight =
        power_heuristic(path.density, lighting_->environment_density(path.from, wi));
    colors_[path.slot] += path.throughput * lighting_->environment(wi) * weight;
  } else if (lighting_->is_seen()) {  // else the background is the picture's business
    colors_[path.slot] += path.throughput * lighting_->environment(wi);
    alphas_[path.slot] = 1;
  }
}

void Wave::widen(const Ray& ray, PathState& path) const {
  const RayDifferential step = world_->camera.differential(ray);
  const DVec3 d(ray.d);
  const double spread = std::sqrt(glm::dot(step.d_dy, step.d_dy) / glm::dot(d, d));
  const double begin = std::sqrt(glm::dot(step.o_dy, step.o_dy));
  path.begin = static_cast<float>(begin) * sample_width_;
  path.spread = static_cast<float>(spread) * sample_width_;
}

void Wave::step(std::size_t i) {
  const Ray& ray = rays_[i];
  PathState& path = paths_[i];
  std::optional<Hit> hit = hits_[i];
  if (hit && depth_ == 1) widen(ray, path);
  ShadingPoint point;
  for (std::uint32_t layer = 0;; ++layer) {
    if (!hit) return escape(ray, path);
    point = shading_->point(ray, *hit, path.begin, path.spread);
    const float coverage = shading_->coverage(point);
    if (coverage == 1) break;
    const std::uint32_t number = pair(sampling::kCoveragePair) + layer * sampling::kLayerPairs;
    if (coverage > 0 && path.sobol.one(number) < coverage) break;
    hit = world_->bvh.next(ray, *hit);
  }
  if (path.absorption != Vec3(0))
    path.throughput *= transmittance(path.absorption, point.at.distance);
  Shading::find_place(point);
  const bool from_camera = path.density == 0;
  if (from_camera) alphas_[path.slot] = 1;
  const Vec3 d = bsdf::unit(ray.d);
  if (const Vec3 emission = shading_->emission(point); emission != Vec3(0)) {
    const float cosine = std::abs(glm::dot(d, point.at.n));
    const float other = lighting_->emitter_density(hit->id, path.from, point.at.distance, cosine);
    const float weight = from_camera ? 1 : power_heuristic(path.density, other);
    colors_[path.slot] += path.throughput * emission * weight;
  }
  if (depth_ >= max_depth_ || point.look->material->unlit) return;

  const int channel = channel_of(*point.look->material, path);
  const bsdf::Frame frame = shading_->frame(point, -d);
  Vec3 wo = frame.to_local(-d);
  wo.z = std::max(wo.z, 1e-5F);  // above, whatever rounding does
  const bsdf::Scattering bsdf(shading_->parameters(point, frame, channel),
                              shading_->layers(point, frame, -d), wo);
  const Vertex vertex{
      .ray = ray, .hit = *hit, .point = point, .frame = frame, .bsdf = bsdf, .channel = channel};
  if (lighting_->can_sample()) ask_light(vertex, path);
  scatter(vertex, path);
}

int Wave::channel_of(const Material& material, const PathState& path) const {
  if (path.channel < 3 || material.dispersion == 0 || !encloses_medium(material))
    return path.channel;
  return std::min(static_cast<int>(3 * path.sobol.pair(pair(sampling::kLightChoicePair)).y), 2);
}

Vec3 Wave::one_channel(const Vertex& vertex, const PathState& path) {
  if (path.channel == vertex.channel) return Vec3(1);
  Vec3 mask(0);
  mask[vertex.channel] = 3;
  return mask;
}

std::size_t Wave::spawn(const Vertex& vertex, const Vec3& direction) {
  spawns_[spawn_count_] = {.ray = &vertex.ray, .hit = vertex.hit, .direction = direction};
  return spawn_count_++;
}

void Wave::ask_light(const Vertex& vertex, const PathState& path) {
  const std::optional<LightSample> light = lighting_->sample(
      {.p = vertex.point.at.p, .n = vertex.frame.n}, path.sobol.pair(pair(sampling::kLightPair)),
      path.sobol.one(pair(sampling::kLightChoicePair)));
  if (!light) return;
  const Vec3 wi = vertex.frame.to_local(light->wi);
  if (!agrees(vertex.point, light->wi, wi.z > 0)) return;
  bsdf::Evaluation f = vertex.bsdf.evaluate(wi);
  if (f.value == Vec3(0)) return;
  if (wi.z < 0) f.value *= one_channel(vertex, path);
  const float weight = light->density > 0 ? power_heuristic(light->density, f.density) : 1;
  shadows_[shadow_count_++] = {.light = *light,
                               .color = path.throughput * f.value * light->light * weight,
                               .slot = path.slot,
                               .spawn = spawn(vertex, light->way)};
}

void Wave::scatter(const Vertex& vertex, const PathState& path) {
  const Vec2 chances = path.sobol.pair(pair(sampling::kLobePair));
  const auto sample =
      vertex.bsdf.sample(path.sobol.pair(pair(sampling::kDirectionPair)), chances.x);
  if (!sample) return;
  const Vec3 wi = vertex.frame.to_world(sample->wi);
  const bool above = sample->wi.z > 0;
  if (!agrees(vertex.point, wi, above)) return;
  PathState next = path;
  next.throughput *= sample->weight;
  if (!above) {
    next.throughput *= one_channel(vertex, path);
    next.channel = vertex.channel;
    if (encloses_medium(*vertex.point.look->material))
      next.absorption = shading_->absorption(vertex.point);
  }
  if (depth_ >= kFirstRoulette) {
    const Vec3& t = next.throughput;
    const float survival = std::min(std::max({t.x, t.y, t.z}), 0.95F);
    if (!(chances.y < survival)) return;
    next.throughput /= survival;
  }
  next.density = sample->density;
  next.from = {.p = vertex.point.at.p, .n = vertex.frame.n};
  next.begin = vertex.point.width;
  // Samples of such a density are about so far apart, and a quarter blurs nothing that is seen.
  next.spread += sample_width_ * 0.25F / std::sqrt(sample->density);
  onwards_[onward_count_++] = {.path = next, .spawn = spawn(vertex, wi)};
}

}  // namespace microtrace
