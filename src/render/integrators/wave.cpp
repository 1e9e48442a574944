#include "render/integrators/wave.hpp"

#include "render/bsdf/frame.hpp"
#include "render/kernels/dispatch.hpp"
#include "render/media/medium_event.hpp"
#include "render/shading/footprint.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// Adds the number of rays, and the time between construction and destruction, to the counts.
class RayTimer {
 public:
  RayTimer(RayCounts::Kind& kind, std::size_t rays) : kind_(kind) { kind.rays += rays; }
  ~RayTimer() { kind_.seconds += std::chrono::duration<double>(Clock::now() - start_).count(); }
  RayTimer(const RayTimer&) = delete;
  RayTimer& operator=(const RayTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  RayCounts::Kind& kind_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

Wave::Wave() : kernels_(&kShadingKernels.best()) {}

void Wave::begin(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids) {
  world_ = &world;
  shading_ = world.shading;
  lighting_ = world.lighting;
  step_ = {.sample_width = 1 / std::sqrt(static_cast<float>(world.samples))};
  vertices_.begin(*shading_, *lighting_);
  media_.clear();
  count_ = rays.size();
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
  options_ = options;
  ground_ = find_ground();
  for (; count_ > 0; ++step_.depth) {
    {
      const RayTimer timer(step_.depth == 1 ? counts_.camera : counts_.path, count_);
      world_->bvh.intersect(std::span(rays_).first(count_), std::span(hits_).first(count_),
                            std::span(left_).first(step_.depth == 1 ? 0 : count_));
    }
    step();
    count_ = outgoing_.spawn_origins(world_->bvh, shadow_rays_,
                                     {.rays = rays_, .left = left_, .states = paths_});
    const RayTimer timer(counts_.shadow, shadow_rays_.count() + ground_shadows_.count());
    counts_.beyond += shadow_rays_.trace(world_->bvh, *shading_, options_.backfaces, colors_);
    if (ground_shadows_.count() == 0) continue;
    counts_.beyond += ground_shadows_.trace(
        world_->bvh, *shading_, options_.backfaces,
        [this](std::size_t slot, float occlusion) { darken(slot, occlusion); });
  }
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = {.color = colors_[i], .alpha = alphas_[i]};
}

void Wave::step() {
  std::array<ShadingPoint, kShadingLanes> points;
  for (std::size_t first = 0; first < count_; first += kShadingLanes) {
    const std::size_t size = std::min<std::size_t>(count_ - first, kShadingLanes);
    shading_->points(*kernels_, std::span(rays_).subspan(first, size),
                     std::span(hits_).subspan(first, size), hit_lanes_, points);
    for (std::size_t i = 0; i < size; ++i) {
      if (hits_[first + i]) prepare(first + i, points[i]);
    }
    for (std::size_t i = 0; i < size; ++i) step(first + i, points[i]);
  }
  vertices_.finish(step_, outgoing_);
}

void Wave::escape(const Ray& ray, const PathState& path) {
  const Vec3 wi = unit<1>(ray.d);
  if (path.pdf > 0) {
    const EnvironmentLight::Lookup light = lighting_->environment(path.from, wi);
    const float other = path.is_scattered ? 0 : light.pdf;
    colors_[path.slot] += path.throughput * light.radiance * power_heuristic(path.pdf, other);
  } else if (lighting_->is_seen()) {  // otherwise the background is composited later
    colors_[path.slot] += path.throughput * lighting_->environment(wi);
    alphas_[path.slot] = 1;
  }
  if (ground_ && path.pdf == 0) meet_ground(ray, path);
}

std::optional<float> Wave::find_ground() const {
  if (!options_.ground) return std::nullopt;
  if (const std::optional<double>& height = options_.ground->height)
    return static_cast<float>(*height - world_->scene.origin.y);
  const std::optional<double>& lowest = lighting_->ground(world_->scene).lowest();
  return lowest ? std::optional(static_cast<float>(*lowest)) : std::nullopt;
}

void Wave::meet_ground(const Ray& ray, const PathState& path) {
  const std::optional<Vec3> p = point_on_ground(ray, *ground_);
  if (!p) return;
  const float choice = path.sobol.pair(step_.pair(sampling::kLightChoicePair)).x;
  const Vec2 u = path.sobol.pair(step_.pair(sampling::kLightPair));
  if (const auto light = lighting_->ground(world_->scene).sample(*p, choice, u))
    ground_shadows_.add(*p, light->to_light, light->is_far, path.slot);
}

void Wave::darken(std::size_t slot, float occlusion) {
  if (lighting_->is_seen())
    colors_[slot] *= 1 - occlusion;
  else
    alphas_[slot] = occlusion;
}

void Wave::widen(const Ray& ray, PathState& path) const {
  const Footprint footprint = camera_footprint(world_->camera, ray, step_.sample_width);
  path.begin = footprint.begin;
  path.spread = footprint.spread;
}

void Wave::prepare(std::size_t i, ShadingPoint& point) {
  PathState& path = paths_[i];
  if (step_.depth == 1) widen(rays_[i], path);
  point.width = path.begin + path.spread * point.at.distance;
  Shading::find_texel_address(point);
}

bool Wave::stops(const PathState& path, const ShadingPoint& point, std::uint32_t layer) const {
  const float coverage = shading_->coverage(point, path.pdf == 0);
  if (coverage == 0 || coverage == 1) return coverage == 1;
  return path.sobol.one(step_.pair(sampling::kCoveragePair) + layer * sampling::kLayerPairs) <
         coverage;
}

std::optional<Hit> Wave::next(std::size_t i, const Hit& hit, ShadingPoint& point) {
  ++counts_.beyond;
  const std::optional<Hit> result = world_->bvh.next(rays_[i], hit);
  if (!result) return result;
  point = shading_->point(rays_[i], *result);
  prepare(i, point);
  return result;
}

Wave::Behind Wave::look_behind(std::size_t i, const Hit& first, ShadingPoint point,
                               std::uint32_t layer) {
  std::optional<Hit> hit = first;
  while (Shading::lets_light_in(point)) {
    do {
      hit = next(i, *hit, point);
      ++layer;
      if (!hit) return {.is_open = lighting_->environment(unit<1>(rays_[i].d)) != Vec3(0)};
    } while (!stops(paths_[i], point, layer));
  }
  if (!point.look->shines() || shading_->emission(point) == Vec3(0)) return {};
  return {.hit = hit, .point = point};
}

bool Wave::passes_hidden_surface(const PathState& path, const ShadingPoint& point) {
  if (path.media == nullptr) return false;
  const Medium* own = Shading::enclosed_medium(point);
  if (!NestedMediaTable::is_hidden(own, point.at.front, path.media)) return false;
  left_bodies_.push_back({.distance = point.at.distance, .medium = own});
  return true;
}

bool Wave::cross_medium(const Ray& ray, const std::optional<Hit>& hit, float distance,
                        PathState& path) {
  const MediumEvent event = microtrace::cross_medium(world_->bvh, step_, ray, hit, distance, path);
  for (const LeftBody& body : left_bodies_) {
    if (event.arrives || body.distance < event.distance)
      path.media = media_.without(path.media, *body.medium);
  }
  if (event.scattered) outgoing_.add_scattered(*event.scattered, path);
  return event.arrives;
}

void Wave::step(std::size_t i, ShadingPoint& point) {
  const Ray& ray = rays_[i];
  PathState& path = paths_[i];
  std::optional<Hit> hit = hits_[i];
  const bool from_camera = path.pdf == 0;
  std::uint32_t layer = 0;
  left_bodies_.clear();
  for (; hit && (passes_hidden_surface(path, point) || !stops(path, point, layer)); ++layer)
    hit = next(i, *hit, point);
  if (path.media != nullptr && !cross_medium(ray, hit, point.at.distance, path)) return;
  if (!hit) return escape(ray, path);
  if (!from_camera && options_.backfaces == Backfaces::pass && Shading::lets_light_in(point) &&
      lighting_->may_surround()) {
    const Behind behind = look_behind(i, *hit, point, layer);
    if (behind.is_open) return escape(ray, path);
    if (behind.hit) hit = behind.hit, point = behind.point;
  }
  if (from_camera) alphas_[path.slot] = 1;
  if (const Vec3 emission = shading_->emission(point); emission != Vec3(0)) {
    const Vec3 d = unit<1>(ray.d);
    const float cosine = std::abs(glm::dot(d, point.at.n));
    const float other = path.is_scattered
                            ? 0
                            : lighting_->emitter_pdf(hit->id, path.from, point.at.distance, cosine);
    const float weight = from_camera ? 1 : power_heuristic(path.pdf, other);
    colors_[path.slot] += path.throughput * emission * weight;
  }
  if (step_.depth - path.scatterings >= options_.max_depth || point.look->material->unlit) return;
  const Material& material = *point.look->material;
  const Vertex vertex{
      .ray = ray,
      .hit = *hit,
      .point = point,
      .path = path,
      .channel = channel_of(material, path),
      .beyond = media_.cross(Shading::enclosed_medium(point), point.at.front, path.media)};
  vertices_.add(step_, vertex, outgoing_);
}

int Wave::channel_of(const Material& material, const PathState& path) const {
  if (path.channel < 3 || material.dispersion == 0 || !refracts(material)) return path.channel;
  return std::min(static_cast<int>(3 * path.sobol.pair(step_.pair(sampling::kLightChoicePair)).y),
                  2);
}

}  // namespace microtrace
