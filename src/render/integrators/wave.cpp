#include "render/integrators/wave.hpp"

#include "render/bsdf/frame.hpp"
#include "render/bsdf/put_surface.hpp"
#include "render/kernels/dispatch.hpp"
#include "render/shading/footprint.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

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

Wave::Wave()
    : kernels_(&kShadingKernels.best()),
      paths_(std::make_unique<PathColumns>()),
      next_paths_(std::make_unique<PathColumns>()) {}

void Wave::begin(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids) {
  world_ = &world;
  shading_ = world.shading;
  lighting_ = world.lighting;
  step_ = {.sample_width = 1 / std::sqrt(static_cast<float>(world.samples))};
  vertices_.begin(*lighting_, world.guide);
  tracer_.begin(world.bvh);
  media_.clear();
  count_ = rays.size();
  PathColumns& paths = *paths_;
  for (std::size_t i = 0; i < count_; ++i) {
    put_vector(paths.o, i, rays[i].o);
    put_vector(paths.d, i, rays[i].d);
    paths.t_min[i] = rays[i].t_min;
    paths.t_max[i] = rays[i].t_max;
    paths.key[i] = ids[i].key;
    paths.index[i] = ids[i].index;
    paths.slot[i] = static_cast<std::uint32_t>(i);
    paths.channel[i] = 3;
    colors_[i] = Vec3(0);
    alphas_[i] = 0;
  }
  for (auto& throughput : paths.throughput) std::fill_n(throughput, count_, 1.0F);
  for (auto* numbers : {paths.media, paths.scatterings, paths.is_scattered})
    std::fill_n(numbers, count_, 0U);
  std::fill_n(paths.pdf, count_, 0.0F);
}

void Wave::intersect(std::span<const Ray> camera_rays) {
  const RayTimer timer(step_.depth == 1 ? counts_.camera : counts_.path, count_);
  if (step_.depth > 1) {
    tracer_.closest(columns_of(*paths_, count_), std::span(hits_).first(count_));
    if (knows_blocked()) find_blocked();
    return;
  }
  world_->bvh.intersect(camera_rays, std::span(camera_hits_).first(count_));
  for (std::size_t i = 0; i < count_; ++i)
    hits_[i] = camera_hits_[i] ? camera_hits_[i]->id : kNoPrimitive;
}

void Wave::trace(const World& world, const PathOptions& options, std::span<const Ray> rays,
                 std::span<const SampleId> ids, std::span<Sample> samples, GuideRecords* records) {
  begin(world, rays, ids);
  options_ = options;
  step_.is_spec = options.bsdf == BsdfModel::spec;
  ground_ = find_ground();
  for (; count_ > 0; ++step_.depth) {
    intersect(rays);
    step();
    const RayTimer timer(counts_.shadow, shadow_rays_.count() + ground_shadows_.count());
    counts_.beyond +=
        shadow_rays_.trace(tracer_, world_->bvh, *shading_, options_.backfaces, colors_);
    if (records != nullptr) recorder_.note(*paths_, count_, colors_);
    if (ground_shadows_.count() == 0) continue;
    counts_.beyond += ground_shadows_.trace(
        world_->bvh, *shading_, options_.backfaces,
        [this](std::size_t slot, float occlusion) { darken(slot, occlusion); });
  }
  if (records != nullptr) recorder_.finish(colors_, *records);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = {.color = colors_[i], .alpha = alphas_[i]};
}

void Wave::step() {
  OutgoingRays outgoing{
      .tracer = tracer_, .shadows = shadow_rays_, .media = media_, .paths = *next_paths_};
  outgoing_ = &outgoing;
  for (std::size_t first = 0; first < count_; first += kShadingLanes) {
    step(first);
    vertices_.add(step_, *paths_, first, outgoing);
  }
  vertices_.finish(step_, outgoing);
  count_ = outgoing.count;
  std::fill_n(next_paths_->t_min, count_, 0.0F);
  std::fill_n(next_paths_->t_max, count_, std::numeric_limits<float>::infinity());
  std::swap(paths_, next_paths_);
}

void Wave::step(std::size_t first) {
  VertexGroup& group = vertices_.group();
  HitGroup& hits = group.hits;
  const auto ids = std::span(hits_).subspan(first).first<kShadingLanes>();
  const std::size_t size = std::min<std::size_t>(count_ - first, kShadingLanes);
  hits.hit = 0;
  for (std::size_t lane = 0; lane < size; ++lane)
    hits.hit |= Lanes{ids[lane] != kNoPrimitive} << lane;
  for (Lanes missed = ((Lanes{1} << size) - 1) & ~hits.hit; missed != 0; missed &= missed - 1) {
    const std::size_t i = first + static_cast<std::size_t>(std::countr_zero(missed));
    left_bodies_.clear();
    if (paths_->media[i] == 0 || cross_medium(i, paths_->ray(i), std::nullopt, 0)) escape(i);
  }
  group.vertices = group.mapped = 0;
  if (hits.hit == 0) return;
  for (int axis = 0; axis < 3; ++axis) {
    std::copy_n(paths_->o[axis] + first, kShadingLanes, hits.lanes.o[axis]);
    std::copy_n(paths_->d[axis] + first, kShadingLanes, hits.lanes.d[axis]);
  }
  std::ranges::copy(ids, group.id);
  if (step_.depth == 1 && shading_->has_textures()) widen(first);
  shading_->find_points(*kernels_, ids, hits);
  const Lanes simple = add_simple(first);
  for (Lanes rest = hits.hit & ~simple; rest != 0; rest &= rest - 1)
    step_slowly(first, std::countr_zero(rest));
}

void Wave::widen(std::size_t first) {
  PathColumns& paths = *paths_;
  for (Lanes rest = vertices_.group().hits.hit; rest != 0; rest &= rest - 1) {
    const std::size_t i = first + static_cast<std::size_t>(std::countr_zero(rest));
    const Footprint footprint = camera_footprint(world_->camera, paths.ray(i), step_.sample_width);
    paths.begin[i] = footprint.begin;
    paths.spread[i] = footprint.spread;
  }
}

Lanes Wave::add_simple(std::size_t first) {
  VertexGroup& group = vertices_.group();
  const PathColumns& paths = *paths_;
  const HitLanes& hits = group.hits.lanes;
  const bool looks_behind = this->looks_behind();
  Lanes simple = 0;
  for (Lanes rest = group.hits.sure; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    const auto k = static_cast<std::size_t>(lane);
    const TexturedMaterial& look = *group.hits.looks[k];
    const bool is_front = hits.from_behind[lane] == 0;
    if (!look.is_simple || !group.hits.meshes[k]->colors.empty() ||
        (is_front ? looks_behind && look.has_open_back && may_get_light(first + k)
                  : !look.has_back) ||
        paths.media[first + k] != 0 || is_last(first + k))
      continue;
    simple |= Lanes{1} << lane;
    group.side[lane] = is_front ? 1.0F : -1.0F;
    group.features[k] = look.constant->features;
    if (group.surface_of[k] == &look) continue;
    group.surface_of[k] = &look;
    put_surface(group.surface, lane, look.constant->parameters);
    if (look.constant->features.index() != 0)
      put_extensions(group.surface, lane, look.constant->parameters, look.constant->layers);
  }
  for (int lane = 0; lane < kShadingLanes; ++lane) {
    const std::size_t i = first + static_cast<std::size_t>(lane);
    group.width[lane] = paths.begin[i] + paths.spread[i] * hits.distance[lane];
    group.on_mesh[lane] = 1;
    group.normals.is_mapped[lane] = group.coat_normals.is_mapped[lane] = 0;
    for (auto& weights : group.through_weight) weights[lane] = 1;
    group.media[lane] = 0;
    group.channel[lane] = paths.channel[i];
  }
  if (step_.depth == 1) {
    for (Lanes rest = simple; rest != 0; rest &= rest - 1)
      alphas_[paths.slot[first + static_cast<std::size_t>(std::countr_zero(rest))]] = 1;
  }
  group.vertices = simple;
  return simple;
}

void Wave::prepare(std::size_t i, ShadingPoint& point) const {
  point.width = paths_->begin[i] + paths_->spread[i] * point.at.distance;
  Shading::find_texel_address(point);
}

void Wave::step_slowly(std::size_t first, int lane) {
  const std::size_t i = first + static_cast<std::size_t>(lane);
  PathColumns& paths = *paths_;
  const HitGroup& hits = vertices_.group().hits;
  const Ray ray = paths.ray(i);
  const bool from_camera = paths.pdf[i] == 0;
  // The parameter t is needed only where find_points() is not sure, and in media.
  const bool is_sure = (hits.sure >> lane & 1U) != 0 && paths.media[i] == 0;
  std::optional<Hit> hit = from_camera ? *camera_hits_[i]
                           : is_sure   ? Hit{.id = hits_[i], .t = 0}
                                       : tracer_.hit(ray, hits_[i]);
  ShadingPoint point = shading_->point(hits, lane, ray, *hit);
  prepare(i, point);
  std::uint32_t layer = 0;
  left_bodies_.clear();
  for (; hit && (passes_hidden_surface(i, point) || !stops(i, point, layer)); ++layer)
    hit = next(i, *hit, point);
  if (paths.media[i] != 0 && !cross_medium(i, ray, hit, point.at.distance)) return;
  if (!hit) return escape(i);
  if (looks_behind() && Shading::lets_light_in(point) && (layer > 0 || may_get_light(i))) {
    const Behind behind = look_behind(i, *hit, point, layer);
    if (behind.is_open) return escape(i);
    if (behind.hit) hit = behind.hit, point = behind.point;
  }
  if (from_camera) alphas_[paths.slot[i]] = 1;
  add_emission(i, *hit, point);
  if (!is_last(i) && !point.look->material->unlit) put_vertex(i, lane, *hit, point);
}

int Wave::channel_of(const Material& material, std::size_t i) const {
  const auto channel = static_cast<int>(paths_->channel[i]);
  if (channel < 3 || material.dispersion == 0 || !refracts(material)) return channel;
  const float u = paths_->sobol(i).pair(step_.pair(sampling::kLightChoicePair)).y;
  return std::min(static_cast<int>(3 * u), 2);
}

void Wave::put_vertex(std::size_t i, int lane, const Hit& hit, const ShadingPoint& point) {
  VertexGroup& group = vertices_.group();
  const auto k = static_cast<std::size_t>(lane);
  const Material& material = *point.look->material;
  const int channel = channel_of(material, i);
  const Beyond beyond =
      media_.cross(Shading::enclosed_medium(point), point.at.front, media_.at(paths_->media[i]));
  const BsdfInput& input = shading_->bsdf_input(point, channel, beyond.outside, varying_);
  group.vertices |= Lanes{1} << lane;
  group.features[k] = input.features;
  group.id[lane] = hit.id;
  put_point(group, lane, point);
  group.surface_of[k] = nullptr;
  put_surface(group.surface, lane, input.parameters);
  if (input.features.index() == 0) return;
  put_extensions(group.surface, lane, input.parameters, input.layers);
  const auto path_channel = static_cast<int>(paths_->channel[i]);
  Vec3 through(1);
  if (path_channel != channel) {
    // A dispersive surface reduces the path to one channel.
    through = Vec3(0);
    through[channel] = 3;
  }
  put(group.through_weight, lane, through);
  group.channel[lane] = static_cast<std::uint32_t>(channel);
  group.media[lane] = NestedMediaTable::number_of(beyond.media);
}

}  // namespace microtrace
