#include "render/integrators/vertex_queue.hpp"

#include "render/bsdf/put_surface.hpp"
#include "render/kernels/dispatch.hpp"
#include "render/kernels/lane_access.hpp"
#include "render/shading/beer_lambert.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

void put_point(NormalLanes& lanes, int lane, const Ray& ray, const SurfacePoint& at) {
  put(lanes.d, lane, ray.d);
  put(lanes.n, lane, at.n);
  put(lanes.ns, lane, at.ns);
  lanes.side[lane] = at.front ? 1.0F : -1.0F;
}

void put_tangents(NormalLanes& lanes, int lane, const SurfacePoint& at) {
  lanes.handedness[lane] = 0;
  if (at.mesh == nullptr || at.mesh->tangents.empty()) return;
  for (std::size_t corner = 0; corner < 3; ++corner)
    put(lanes.tangents[corner], lane, Vec3(at.mesh->tangents[at.corners[corner]]));
  lanes.handedness[lane] = at.mesh->tangents[at.corners[0]].w;
  put(lanes.weights, lane, at.barycentrics);
}

void put_map(NormalMapLanes& lanes, int lane, const ShadingPoint& point, const TextureSlot& slot,
             float scale) {
  lanes.is_mapped[lane] = slot.map == nullptr ? 0.0F : 1.0F;
  if (slot.map == nullptr) return;
  put(lanes.texel, lane, Vec3(slot.at(point)));
  lanes.scale[lane] = scale;
}

/// The weight of a path that crosses the surface. If a dispersive surface reduces the path to one
/// channel, the weight is 3 for this channel and 0 for the others.
Vec3 through_weight(const Vertex& vertex) {
  if (vertex.path.channel == vertex.channel) return Vec3(1);
  Vec3 weight(0);
  weight[vertex.channel] = 3;
  return weight;
}

}  // namespace

ScatterSetup scatter_setup(const WaveStep& step, const bsdf::Features& features) {
  return {.features = features,
          .direction_pair = step.pair(sampling::kDirectionPair),
          .lobe_pair = step.pair(sampling::kLobePair),
          .most_survival = step.most_survival()};
}

void VertexQueue::begin(const Lighting& lighting) {
  if (!lighting.can_sample()) std::memset(scatter_.light, 0, sizeof scatter_.light);
}

void VertexQueue::add(const Vertex& vertex, const bsdf::Parameters& parameters,
                      const bsdf::Layers& layers) {
  const int lane = count_++;
  const ShadingPoint& point = vertex.point;
  const PathState& path = vertex.path;
  // Without a temporary object, which would be copied in larger pieces than it was written in.
  PendingVertex& pending = pending_[static_cast<std::size_t>(lane)];
  pending.ray = &vertex.ray;
  pending.hit = vertex.hit;
  pending.path = &path;
  pending.width = point.width;
  pending.channel = vertex.channel;
  pending.media = vertex.beyond.media;
  put(light_choices_.p, lane, point.at.p);
  put_point(points_, lane, vertex.ray, point.at);
  add_normal_maps(lane, point);
  put(scatter_.d, lane, vertex.ray.d);
  put(scatter_.outwards, lane, points_.side[lane] * point.at.n);
  put(scatter_.throughput, lane, path.throughput);
  scatter_.key[lane] = path.sobol.key();
  scatter_.index[lane] = path.sobol.index();
  put_surface(scatter_.surface, lane, parameters);
  if (features_.index() == 0) return;
  put_extensions(scatter_.surface, lane, parameters, layers);
  put(scatter_.through_weight, lane, through_weight(vertex));
}

void VertexQueue::add_normal_maps(int lane, const ShadingPoint& point) {
  const TexturedMaterial& look = *point.look;
  const TextureSlot& base = look[MaterialTexture::normal];
  const TextureSlot& coat = look[MaterialTexture::clearcoat_normal];
  if (base.map != nullptr || coat.map != nullptr) put_tangents(points_, lane, point.at);
  put_map(normals_, lane, point, base, look.material->normal_scale);
  if (features_.layers != bsdf::LayerSide::none && look.material->clearcoat)
    put_map(coat_normals_, lane, point, coat, look.material->clearcoat->normal_scale);
}

void VertexQueue::find_frames() {
  kernels_.find_normals(points_, normals_);
  std::memcpy(scatter_.frame_n, normals_.normal, sizeof scatter_.frame_n);
  if (features_.layers == bsdf::LayerSide::none) return;
  kernels_.find_normals(points_, coat_normals_);
  std::memcpy(scatter_.surface.coat_normal, coat_normals_.normal,
              sizeof scatter_.surface.coat_normal);
}

void VertexQueue::sample_lights(const WaveStep& step, const Lighting& lighting) {
  alignas(64) LaneFloats unused;
  kernels_.random_pairs(scatter_.key, scatter_.index, step.pair(sampling::kLightPair),
                        triangle_lights_.u[0], triangle_lights_.u[1]);
  kernels_.random_pairs(scatter_.key, scatter_.index, step.pair(sampling::kLightChoicePair),
                        light_choices_.choice, unused);
  std::memcpy(light_choices_.n, scatter_.frame_n, sizeof light_choices_.n);
  lighting.sample(kernels_, count_, light_choices_, triangle_lights_, lights_);
  for (int lane = 0; lane < count_; ++lane) {
    const LightSample& light = lights_[static_cast<std::size_t>(lane)];
    put(scatter_.light_wi, lane, light.wi);
    put(scatter_.light, lane, light.light);
    scatter_.light_pdf[lane] = light.pdf;
  }
}

void VertexQueue::finish(const WaveStep& step, const Lighting& lighting, OutgoingRays& outgoing) {
  if (count_ == 0) return;
  find_frames();
  if (lighting.can_sample()) sample_lights(step, lighting);
  kernels_.scatter(scatter_setup(step, features_), scatter_);
  for (int lane = 0; lane < count_; ++lane) {
    const auto i = static_cast<std::size_t>(lane);
    if (const Vec3 color = got(scatter_.shadow, lane); color != Vec3(0)) {
      outgoing.add_shadow(*pending_[i].ray, pending_[i].hit, lights_[i],
                          color * light_transmittance(lane), pending_[i].path->slot);
    }
    if (scatter_.pdf[lane] > 0) continue_path(lane, step, outgoing);
  }
  count_ = 0;
}

Vec3 VertexQueue::light_transmittance(int lane) const {
  const auto i = static_cast<std::size_t>(lane);
  const LightSample& light = lights_[i];
  const bool is_below = glm::dot(got(scatter_.outwards, lane), light.wi) < 0;
  const NestedMedia* media = is_below ? pending_[i].media : pending_[i].path->media;
  if (media == nullptr) return Vec3(1);
  const Medium& medium = *media->medium;
  // Lights that are infinitely far away are visible only in media without an end. As for paths,
  // such a medium is treated as a vacuum if it only absorbs.
  if (light.is_far && !medium.scatters()) return Vec3(1);
  const float distance = light.is_far ? std::numeric_limits<float>::infinity()
                                      : std::sqrt(glm::dot(light.to_light, light.to_light));
  return beer_lambert(medium.extinction, distance);
}

void VertexQueue::continue_path(int lane, const WaveStep& step, OutgoingRays& outgoing) const {
  const PendingVertex& vertex = pending_[static_cast<std::size_t>(lane)];
  const float pdf = scatter_.pdf[lane];
  PathState& next = outgoing.add_path(*vertex.ray, vertex.hit, got(scatter_.wi, lane));
  next = *vertex.path;
  next.throughput = got(scatter_.next_throughput, lane);
  next.pdf = pdf;
  next.from.p = got(light_choices_.p, lane);
  next.from.n = got(scatter_.frame_n, lane);
  next.is_scattered = false;
  next.begin = vertex.width;
  next.spread += step.spread(pdf);
  if (!features_.transmits || scatter_.is_below[lane] == 0) return;
  next.channel = vertex.channel;
  next.media = vertex.media;
}

VertexQueues::VertexQueues() : kernels_(kShadingKernels.best()) {}

void VertexQueues::begin(const Shading& shading, const Lighting& lighting) {
  shading_ = &shading;
  lighting_ = &lighting;
  for (const auto& queue : queues_) {
    if (queue) queue->begin(lighting);
  }
}

void VertexQueues::add(const WaveStep& step, const Vertex& vertex, OutgoingRays& outgoing) {
  const BsdfInput& input =
      shading_->bsdf_input(vertex.point, vertex.channel, vertex.beyond.outside, varying_);
  std::unique_ptr<VertexQueue>& queue = queues_[static_cast<std::size_t>(input.features.index())];
  if (!queue) {
    queue = std::make_unique<VertexQueue>(input.features, kernels_);
    queue->begin(*lighting_);
  }
  queue->add(vertex, input.parameters, input.layers);
  if (queue->is_full()) queue->finish(step, *lighting_, outgoing);
}

void VertexQueues::finish(const WaveStep& step, OutgoingRays& outgoing) {
  for (const auto& queue : queues_) {
    if (queue) queue->finish(step, *lighting_, outgoing);
  }
}

}  // namespace microtrace
