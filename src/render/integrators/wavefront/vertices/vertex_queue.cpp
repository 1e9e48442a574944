#include "render/integrators/wavefront/vertices/vertex_queue.hpp"

#include "render/lanes/dispatch.hpp"
#include "render/lanes/lane_access.hpp"
#include "render/media/beer_lambert.hpp"
#include "simd/lane_count.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// The lanes in which a comparison is true.
template <class F>
Lanes lanes_where(const F& condition) {
  Lanes lanes = 0;
  for (int lane = 0; lane < kShadingLanes; ++lane)
    lanes |= Lanes{condition(lane) ? 1U : 0U} << lane;
  return lanes;
}

/// The first n of these lanes.
Lanes first_of(Lanes lanes, int n) {
  while (lane_count(lanes) > n) lanes &= ~std::bit_floor(lanes);
  return lanes;
}

}  // namespace

ScatterSetup scatter_setup(const WaveStep& step, const bsdf::Features& features) {
  ScatterSetup setup{.features = features,
                     .direction_pair = step.pair(sampling::kDirectionPair),
                     .lobe_pair = step.pair(sampling::kLobePair),
                     .most_survival = step.most_survival()};
  setup.features.is_spec = step.is_spec;
  return setup;
}

void VertexQueue::begin(const Lighting& lighting, const PathGuide* guide) {
  guide_ = guide;
  if (!lighting.can_sample()) std::memset(scatter_.light, 0, sizeof scatter_.light);
  // The rays of all vertices end nowhere, because their hits are known.
  std::ranges::fill(left_.t_max, std::numeric_limits<float>::infinity());
}

Lanes VertexQueue::add(Lanes lanes, const Vertices& from) {
  const Lanes added = first_of(lanes, kShadingLanes - count_);
  const auto to = static_cast<std::size_t>(count_);
  const auto& [group, paths, first] = from;
  if (from_paths_.begins(&paths)) list_paths(paths);
  if (from_group_.begins(&group)) list_group(group);
  count_ += static_cast<int>(
      from_paths_.append(kernels_, {.lanes = added, .from = first, .to = to, .fills_lanes = true}));
  const AppendedLanes in_group{.lanes = added, .from = 0, .to = to, .fills_lanes = true};
  from_group_.append(kernels_, in_group);
  if ((group.mapped & added) != 0) from_maps_.append(kernels_, in_group);
  if (features_.index() != 0) from_extensions_.append(kernels_, in_group);
  return lanes & ~added;
}

void VertexQueue::find_frames() {
  copy(points_.d, left_.d);
  copy(scatter_.d, left_.d);
  for (int axis = 0; axis < 3; ++axis) {
    for (int lane = 0; lane < kShadingLanes; ++lane)
      scatter_.outwards[axis][lane] = points_.side[lane] * points_.n[axis][lane];
  }
  kernels_.find_normals(points_, normals_);
  copy(scatter_.frame_n, normals_.normal);
  if (features_.layers == bsdf::LayerSide::none) return;
  kernels_.find_normals(points_, coat_normals_);
  copy(scatter_.surface.coat_normal, coat_normals_.normal);
}

void VertexQueue::sample_lights(const WaveStep& step, const Lighting& lighting) {
  LightChoices<kShadingLanes>& points = choices_.points;
  TriangleChoices<kShadingLanes>& triangles = choices_.triangles;
  kernels_.random_pairs(scatter_.key, scatter_.index, step.pair(sampling::kLightPair),
                        triangles.u[0], triangles.u[1]);
  kernels_.random_numbers(scatter_.key, scatter_.index, step.pair(sampling::kLightChoicePair),
                          points.choice);
  copy(points.n, scatter_.frame_n);
  lighting.sample(kernels_, count_, choices_, lights_);
  copy(scatter_.light_wi, lights_.wi);
  copy(scatter_.light, lights_.light);
  std::memcpy(scatter_.light_pdf, lights_.pdf, sizeof lights_.pdf);
}

void VertexQueue::finish(const WaveStep& step, const Lighting& lighting, OutgoingRays& outgoing) {
  if (count_ == 0) return;
  find_frames();
  if (lighting.can_sample()) sample_lights(step, lighting);
  if (guide_ == nullptr)
    kernels_.scatter(scatter_setup(step, features_), scatter_);
  else
    guided_.scatter(*guide_, kernels_, scatter_setup(step, features_), {choices_.points.p, count_},
                    scatter_);
  const Lanes vertices = (Lanes{1} << count_) - 1;
  const auto& shadow = scatter_.shadow;
  const Lanes lit =
      vertices & lanes_where([&](int lane) {
        return (shadow[0][lane] != 0) | (shadow[1][lane] != 0) | (shadow[2][lane] != 0);
      });
  const Lanes next = vertices & lanes_where([&](int lane) { return scatter_.pdf[lane] > 0; });
  if ((lit | next) != 0) {
    const Lanes on_meshes = lanes_where([&](int lane) { return on_mesh_[lane] != 0; });
    outgoing.tracer.set_hits(std::span(ids_).first(static_cast<std::size_t>(count_)),
                             on_meshes & vertices, left_);
    if (lit != 0) cast_shadows(lit, outgoing);
    if (next != 0) continue_paths(next, step, outgoing);
  }
  count_ = 0;
}

void VertexQueue::cross_media(Lanes lanes, const NestedMediaTable& media) {
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    shadow_media_[lane] = 0;
    if (media_[lane] == 0 && (!features_.transmits || below_media_[lane] == 0)) continue;
    const Vec3 wi = got(lights_.wi, lane);
    const bool is_below = glm::dot(got(scatter_.outwards, lane), wi) < 0;
    shadow_media_[lane] = is_below ? below_media_[lane] : media_[lane];
    const NestedMedia* here = media.at(shadow_media_[lane]);
    if (here == nullptr) continue;
    const Medium& medium = *here->medium;
    // Lights that are infinitely far away are visible only in media without an end. As for paths,
    // such a medium is treated as a vacuum if it only absorbs.
    const bool is_far = lights_.is_far[lane] != 0;
    if (is_far && !medium.scatters()) continue;
    const Vec3 to_light = got(lights_.to_light, lane);
    const float distance =
        is_far ? std::numeric_limits<float>::infinity() : std::sqrt(glm::dot(to_light, to_light));
    put(scatter_.shadow, lane,
        got(scatter_.shadow, lane) * beer_lambert(medium.extinction, distance));
  }
}

void VertexQueue::cast_shadows(Lanes lanes, OutgoingRays& outgoing) {
  if (outgoing.media.empty())
    std::ranges::fill(shadow_media_, 0U);
  else
    cross_media(lanes, outgoing.media);
  copy(origins_.direction, lights_.to_light);
  const Lanes found = outgoing.tracer.leave(lanes, origins_);
  outgoing.shadows.add(kernels_, found,
                       {.rays = origins_,
                        .left = ids_,
                        .slots = slots_,
                        .media = shadow_media_,
                        .samples = lights_,
                        .light = scatter_.shadow});
}

void VertexQueue::continue_paths(Lanes lanes, const WaveStep& step, OutgoingRays& outgoing) {
  copy(origins_.direction, scatter_.wi);
  const Lanes found = outgoing.tracer.leave(lanes, origins_);
  for (int lane = 0; lane < kShadingLanes && step.has_textures; ++lane)
    spreads_[lane] += (found >> lane & 1U) != 0 ? step.spread(scatter_.pdf[lane]) : 0;
  if (features_.transmits) {
    for (int lane = 0; lane < kShadingLanes; ++lane) {
      if (scatter_.is_below[lane] == 0) continue;
      channels_[lane] = below_channels_[lane];
      media_[lane] = below_media_[lane];
    }
  }
  if (to_paths_.begins(&outgoing.paths)) list_next(outgoing.paths);
  outgoing.count += to_paths_.append(kernels_, {.lanes = found, .from = 0, .to = outgoing.count});
}

VertexQueues::VertexQueues()
    : kernels_(kShadingKernels.best()), group_(std::make_unique<VertexGroup>()) {}

void VertexQueues::begin(const Lighting& lighting, const PathGuide* guide) {
  lighting_ = &lighting;
  guide_ = guide;
  // Materials of a previous scene may have had the same addresses.
  group_->surface_of.fill(nullptr);
  for (const auto& queue : queues_) {
    if (queue) queue->begin(lighting, guide);
  }
}

void VertexQueues::add(const WaveStep& step, const PathColumns& paths, std::size_t first,
                       OutgoingRays& outgoing) {
  const auto add = [&](const bsdf::Features& features, Lanes lanes) {
    std::unique_ptr<VertexQueue>& queue = queues_[static_cast<std::size_t>(features.index())];
    if (!queue) {
      queue = std::make_unique<VertexQueue>(features, kernels_);
      queue->begin(*lighting_, guide_);
    }
    while (lanes != 0) {
      lanes = queue->add(lanes, {.group = *group_, .paths = paths, .first = first});
      if (queue->is_full()) queue->finish(step, *lighting_, outgoing);
    }
  };
  if (const Lanes plain = group_->vertices & group_->plain; plain != 0) add({}, plain);
  for (Lanes rest = group_->vertices & ~group_->plain; rest != 0;) {
    const auto some = static_cast<std::size_t>(std::countr_zero(rest));
    const bsdf::Features& features = group_->features[some];
    Lanes lanes = 0;  // those with the same features
    for (Lanes others = rest; others != 0; others &= others - 1) {
      const int lane = std::countr_zero(others);
      if (group_->features[static_cast<std::size_t>(lane)].index() == features.index())
        lanes |= Lanes{1} << lane;
    }
    rest &= ~lanes;
    add(features, lanes);
  }
}

void VertexQueues::finish(const WaveStep& step, OutgoingRays& outgoing) {
  for (const auto& queue : queues_) {
    if (queue) queue->finish(step, *lighting_, outgoing);
  }
}

}  // namespace microtrace
