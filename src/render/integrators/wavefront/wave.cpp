#include "render/integrators/wavefront/wave.hpp"

#include "accel/intersect_fronts.hpp"
#include "render/integrators/ray_timer.hpp"
#include "render/lanes/dispatch.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace microtrace {
Wave::Wave()
    : kernels_(&kShadingKernels.best()),
      paths_(std::make_unique<PathColumns>()),
      next_paths_(std::make_unique<PathColumns>()) {}

void Wave::begin(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids) {
  world_ = &world;
  shading_ = world.shading;
  lighting_ = world.lighting;
  step_ = {.sample_width = 1 / std::sqrt(static_cast<float>(world.samples)),
           .has_textures = shading_->has_textures()};
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
    tracer_.closest(columns_of(*paths_, count_), {.masked = masked()},
                    std::span(hits_).first(count_));
    if (knows_blocked()) find_blocked();
    return;
  }
  intersect_fronts(world_->bvh, camera_rays, world_->open_backs,
                   std::span(camera_hits_).first(count_));
  for (std::size_t i = 0; i < count_; ++i)
    hits_[i] = camera_hits_[i] ? camera_hits_[i]->id : kNoPrimitive;
  if (shading_->masked() != nullptr) find_visible();
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
        shadow_rays_.trace(tracer_, world_->bvh, *shading_, options_, media_, colors_);
    if (records != nullptr) recorder_.note(*paths_, count_, colors_);
    if (ground_shadows_.count() == 0) continue;
    counts_.beyond += ground_shadows_.trace(
        world_->bvh, *shading_, options_,
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
  passed_ = 0;
  do {
    for (std::size_t first = 0; first < count_; first += kShadingLanes) {
      step(first);
      vertices_.add(step_, *paths_, first, outgoing);
    }
    escape();
  } while (continue_passing());
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
  Lanes escaped = 0;
  for (Lanes missed = ((Lanes{1} << size) - 1) & ~hits.hit; missed != 0; missed &= missed - 1) {
    const int lane = std::countr_zero(missed);
    const std::size_t i = first + static_cast<std::size_t>(lane);
    crossed_.clear();
    if (paths_->media[i] == 0 || cross_medium(i, paths_->ray(i), std::nullopt, 0))
      escaped |= Lanes{1} << lane;
  }
  group.vertices = group.mapped = 0;
  if (hits.hit != 0) escaped |= meet_surfaces(first);
  for (; escaped != 0; escaped &= escaped - 1) {
    escaped_[escaped_count_++] =
        static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(std::countr_zero(escaped));
  }
}

}  // namespace microtrace
