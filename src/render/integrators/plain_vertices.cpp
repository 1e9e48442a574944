#include "render/integrators/plain_vertices.hpp"

#include "render/bsdf/ggx_albedo_table.hpp"
#include "render/kernels/dispatch.hpp"
#include "render/kernels/lane_access.hpp"

#include <algorithm>
#include <cstring>
#include <optional>

namespace microtrace {
namespace {

void put_tangents(NormalLanes& lanes, int lane, const SurfacePoint& at) {
  lanes.handedness[lane] = 0;
  if (at.mesh == nullptr || at.mesh->tangents.empty()) return;
  for (std::size_t corner = 0; corner < 3; ++corner)
    put(lanes.tangents[corner], lane, Vec3(at.mesh->tangents[at.corners[corner]]));
  lanes.handedness[lane] = at.mesh->tangents[at.corners[0]].w;
  put(lanes.weights, lane, at.barycentrics);
}

}  // namespace

ScatterSetup scatter_setup(const WaveStep& step) {
  return {.direction_pair = step.pair(sampling::kDirectionPair),
          .lobe_pair = step.pair(sampling::kLobePair),
          .most_survival = step.most_survival(),
          .albedo_steps = bsdf::kAlbedoSteps,
          .albedo_f1 = bsdf::kAlbedoF1[0].data(),
          .albedo_schlick = bsdf::kAlbedoSchlick[0].data(),
          .mean_albedo_f1 = bsdf::kMeanAlbedoF1.data(),
          .mean_albedo_schlick = bsdf::kMeanAlbedoSchlick.data()};
}

PlainVertices::PlainVertices() : kernels_(&best_shading_kernels()) {}

void PlainVertices::begin(const Lighting& lighting) {
  lighting_ = &lighting;
  // Without light sampling, no light of another scene may be left over.
  std::memset(scatter_.light, 0, sizeof scatter_.light);
}

void PlainVertices::add(const WaveStep& step, const Shading& shading, const Ray& ray,
                        const Hit& hit, const ShadingPoint& point, const PathState& path,
                        Departures& departures) {
  const int lane = count_++;
  vertices_[static_cast<std::size_t>(lane)] = {
      .ray = &ray, .hit = hit, .path = &path, .p = point.at.p, .width = point.width};
  const float side = point.at.front ? 1.0F : -1.0F;
  put(normals_.d, lane, ray.d);
  put(normals_.n, lane, point.at.n);
  put(normals_.ns, lane, point.at.ns);
  normals_.side[lane] = side;
  const TextureSlot& normal_map = (*point.look)[MaterialTexture::normal];
  if (normal_map.map != nullptr) {
    put_tangents(normals_, lane, point.at);
    put(normals_.texel, lane, Vec3(normal_map.at(point)));
    normals_.scale[lane] = point.look->material->normal_scale;
  } else {
    normals_.handedness[lane] = 0;
  }
  put(scatter_.d, lane, ray.d);
  put(scatter_.outwards, lane, side * point.at.n);
  const bsdf::Parameters p = shading.plain_parameters(point);
  put(scatter_.base_color, lane, p.base_color);
  scatter_.metallic[lane] = p.metallic;
  scatter_.roughness[lane] = p.roughness;
  put(scatter_.f0, lane, p.dielectric.f0);
  scatter_.f90[lane] = p.dielectric.f90;
  put(scatter_.throughput, lane, path.throughput);
  scatter_.key[lane] = path.sobol.key();
  scatter_.index[lane] = path.sobol.index();
  if (count_ == kShadingLanes) finish(step, departures);
}

void PlainVertices::ask_lights(const WaveStep& step) {
  alignas(64) LaneFloats u, v, choice, unused;
  kernels_->random_pairs(scatter_.key, scatter_.index, step.pair(sampling::kLightPair), u, v);
  kernels_->random_pairs(scatter_.key, scatter_.index, step.pair(sampling::kLightChoicePair),
                         choice, unused);
  for (int lane = 0; lane < count_; ++lane) {
    const auto i = static_cast<std::size_t>(lane);
    const std::optional<LightSample> light = lighting_->sample(
        {.p = vertices_[i].p, .n = got(normals_.frame_n, lane)}, {u[lane], v[lane]}, choice[lane]);
    lights_[i] = light.value_or(LightSample{});
    put(scatter_.light_wi, lane, lights_[i].wi);
    put(scatter_.light, lane, lights_[i].light);
    scatter_.light_pdf[lane] = lights_[i].pdf;
  }
}

void PlainVertices::finish(const WaveStep& step, Departures& departures) {
  if (count_ == 0) return;
  kernels_->find_normals(normals_);
  std::memcpy(scatter_.frame_n, normals_.frame_n, sizeof scatter_.frame_n);
  if (lighting_->can_sample()) ask_lights(step);
  kernels_->scatter(scatter_setup(step), scatter_);
  for (int lane = 0; lane < count_; ++lane) {
    const Vertex& vertex = vertices_[static_cast<std::size_t>(lane)];
    if (const Vec3 color = got(scatter_.shadow, lane); color != Vec3(0)) {
      departures.add_shadow(*vertex.ray, vertex.hit, lights_[static_cast<std::size_t>(lane)], color,
                            vertex.path->slot);
    }
    const float pdf = scatter_.pdf[lane];
    if (!(pdf > 0)) continue;
    PathState& next = departures.add_path(*vertex.ray, vertex.hit, got(scatter_.wi, lane));
    next = *vertex.path;
    next.throughput = got(scatter_.next_throughput, lane);
    next.pdf = pdf;
    next.from = {.p = vertex.p, .n = got(scatter_.frame_n, lane)};
    next.begin = vertex.width;
    next.spread += step.spread(pdf);
  }
  count_ = 0;
}

}  // namespace microtrace
