#include "render/integrators/vertex_queue.hpp"

#include "render/integrators/column_list.hpp"
#include "render/kernels/dispatch.hpp"
#include "render/kernels/lane_access.hpp"
#include "render/shading/beer_lambert.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

const LaneNumbers kNone{};

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
  while (std::popcount(lanes) > n) lanes &= ~std::bit_floor(lanes);
  return lanes;
}

template <std::size_t n>
void copy(LaneFloats (&to)[n], const LaneFloats (&from)[n]) {
  std::memcpy(to, from, sizeof to);
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
  const HitLanes& hits = group.hits.lanes;
  ColumnList of_paths, of_group;
  of_paths.add(paths.throughput, scatter_.throughput);
  of_paths.add(paths.media, media_);
  of_paths.add(paths.scatterings, scatterings_);
  of_paths.add(paths.key, scatter_.key);
  of_paths.add(paths.index, scatter_.index);
  of_paths.add(paths.slot, slots_);
  of_paths.add(paths.channel, channels_);
  of_paths.add(paths.spread, spreads_);
  of_paths.add(paths.t_min, left_.t_min);
  of_paths.append(kernels_, {.lanes = added, .from = first, .to = to});

  of_group.add(hits.o, left_.o);
  of_group.add(hits.d, left_.d);
  of_group.add(hits.corners[0], left_.a);
  of_group.add(hits.corners[1], left_.b);
  of_group.add(hits.corners[2], left_.c);
  of_group.add(hits.p, choices_.points.p);
  of_group.add(hits.n, points_.n);
  of_group.add(hits.ns, points_.ns);
  of_group.add(group.side, points_.side);
  of_group.add(group.id, ids_);
  of_group.add(group.on_mesh, on_mesh_);
  of_group.add(group.width, widths_);
  of_group.add(group.normals.is_mapped, normals_.is_mapped);
  of_group.add(group.surface.base_color, scatter_.surface.base_color);
  of_group.add(group.surface.metallic, scatter_.surface.metallic);
  of_group.add(group.surface.roughness, scatter_.surface.roughness);
  of_group.add(group.surface.f0, scatter_.surface.f0);
  of_group.add(group.surface.f90, scatter_.surface.f90);
  if ((group.mapped & added) != 0) {
    for (int corner = 0; corner < 3; ++corner)
      of_group.add(group.tangents[corner], points_.tangents[corner]);
    of_group.add(group.handedness, points_.handedness);
    of_group.add(hits.weights, points_.weights);
    of_group.add(group.normals.texel, normals_.texel);
    of_group.add(group.normals.scale, normals_.scale);
  }
  of_group.append(kernels_, {.lanes = added, .from = 0, .to = to});
  if (features_.index() != 0) add_extensions(added, group);
  count_ += std::popcount(added);
  return lanes & ~added;
}

void VertexQueue::add_extensions(Lanes lanes, const VertexGroup& group) {
  const SurfaceLanes& from = group.surface;
  SurfaceLanes& to = scatter_.surface;
  ColumnList list;
  list.add(from.transmission, to.transmission);
  list.add(from.eta, to.eta);
  list.add(from.diffuse_transmission, to.diffuse_transmission);
  list.add(from.diffuse_transmission_color, to.diffuse_transmission_color);
  list.add(from.anisotropy, to.anisotropy);
  list.add(from.along, to.along);
  list.add(from.film_share, to.film_share);
  list.add(from.film_ior, to.film_ior);
  list.add(from.film_thickness, to.film_thickness);
  list.add(from.sheen, to.sheen);
  list.add(from.sheen_roughness, to.sheen_roughness);
  list.add(from.coat, to.coat);
  list.add(from.coat_roughness, to.coat_roughness);
  list.add(group.through_weight, scatter_.through_weight);
  list.add(group.media, below_media_);
  list.add(group.channel, below_channels_);
  list.add(group.coat_normals.is_mapped, coat_normals_.is_mapped);
  list.add(group.coat_normals.texel, coat_normals_.texel);
  list.add(group.coat_normals.scale, coat_normals_.scale);
  list.append(kernels_, {.lanes = lanes, .from = 0, .to = static_cast<std::size_t>(count_)});
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
  alignas(64) LaneFloats unused;
  auto& [points, triangles] = choices_;
  kernels_.random_pairs(scatter_.key, scatter_.index, step.pair(sampling::kLightPair),
                        triangles.u[0], triangles.u[1]);
  kernels_.random_pairs(scatter_.key, scatter_.index, step.pair(sampling::kLightChoicePair),
                        points.choice, unused);
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
    guided_.scatter(*guide_, kernels_, step, scatter_setup(step, features_),
                    {choices_.points.p, count_}, scatter_);
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
    if (media_[lane] == 0 && (!features_.transmits || below_media_[lane] == 0)) continue;
    const Vec3 wi = got(lights_.wi, lane);
    const bool is_below = glm::dot(got(scatter_.outwards, lane), wi) < 0;
    const NestedMedia* here = media.at(is_below ? below_media_[lane] : media_[lane]);
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
  cross_media(lanes, outgoing.media);
  copy(origins_.direction, lights_.to_light);
  const Lanes found = outgoing.tracer.leave(lanes, origins_);
  outgoing.shadows.add(kernels_, found,
                       {.rays = origins_,
                        .left = ids_,
                        .slots = slots_,
                        .samples = lights_,
                        .light = scatter_.shadow});
}

void VertexQueue::continue_paths(Lanes lanes, const WaveStep& step, OutgoingRays& outgoing) {
  copy(origins_.direction, scatter_.wi);
  const Lanes found = outgoing.tracer.leave(lanes, origins_);
  for (int lane = 0; lane < kShadingLanes; ++lane)
    spreads_[lane] += (found >> lane & 1U) != 0 ? step.spread(scatter_.pdf[lane]) : 0;
  if (features_.transmits) {
    for (int lane = 0; lane < kShadingLanes; ++lane) {
      if (scatter_.is_below[lane] == 0) continue;
      channels_[lane] = below_channels_[lane];
      media_[lane] = below_media_[lane];
    }
  }
  PathColumns& paths = outgoing.paths;
  ColumnList list;
  list.add(origins_.origin, paths.o);
  list.add(origins_.direction, paths.d);
  list.add(ids_, paths.left);
  list.add(scatter_.key, paths.key);
  list.add(scatter_.index, paths.index);
  list.add(slots_, paths.slot);
  list.add(scatter_.next_throughput, paths.throughput);
  list.add(scatter_.pdf, paths.pdf);
  list.add(choices_.points.p, paths.from_p);
  list.add(scatter_.frame_n, paths.from_n);
  list.add(media_, paths.media);
  list.add(scatterings_, paths.scatterings);
  list.add(kNone, paths.is_scattered);
  list.add(channels_, paths.channel);
  list.add(widths_, paths.begin);
  list.add(spreads_, paths.spread);
  list.append(kernels_, {.lanes = found, .from = 0, .to = outgoing.count});
  outgoing.count += static_cast<std::size_t>(std::popcount(found));
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
  for (Lanes rest = group_->vertices; rest != 0;) {
    const auto some = static_cast<std::size_t>(std::countr_zero(rest));
    const bsdf::Features& features = group_->features[some];
    const int index = features.index();
    Lanes lanes = 0;  // those with the same features
    for (Lanes others = rest; others != 0; others &= others - 1) {
      const int lane = std::countr_zero(others);
      if (group_->features[static_cast<std::size_t>(lane)].index() == index)
        lanes |= Lanes{1} << lane;
    }
    rest &= ~lanes;
    std::unique_ptr<VertexQueue>& queue = queues_[static_cast<std::size_t>(index)];
    if (!queue) {
      queue = std::make_unique<VertexQueue>(features, kernels_);
      queue->begin(*lighting_, guide_);
    }
    while (lanes != 0) {
      lanes = queue->add(lanes, {.group = *group_, .paths = paths, .first = first});
      if (queue->is_full()) queue->finish(step, *lighting_, outgoing);
    }
  }
}

void VertexQueues::finish(const WaveStep& step, OutgoingRays& outgoing) {
  for (const auto& queue : queues_) {
    if (queue) queue->finish(step, *lighting_, outgoing);
  }
}

}  // namespace microtrace
