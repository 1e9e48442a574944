/// The surfaces that the paths of a wavefront meet.

#include "render/bsdf/put_surface.hpp"
#include "render/integrators/wavefront/wave.hpp"
#include "render/lanes/lane_access.hpp"
#include "render/shading/points/footprint.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

namespace microtrace {
namespace {

/// True if the surface of a body reflects all light of some color channel from some directions,
/// because its index of refraction is lower behind the surface. `outside` is the medium around the
/// body; null for a vacuum.
bool may_reflect_totally(const ShadingPoint& point, const Medium* outside) {
  const Medium& inside = point.look->medium;
  for (int channel = 0; channel < 3; ++channel) {
    const float within = inside.ior_of(channel);
    const float around = outside == nullptr ? 1 : outside->ior_of(channel);
    if (point.at.front ? within < around : within > around) return true;
  }
  return false;
}

}  // namespace

Lanes Wave::meet_surfaces(std::size_t first) {
  VertexGroup& group = vertices_.group();
  HitGroup& hits = group.hits;
  const auto ids = std::span(hits_).subspan(first).first<kShadingLanes>();
  for (int axis = 0; axis < 3; ++axis) {
    std::memcpy(hits.lanes.o[axis], paths_->o[axis] + first, sizeof(LaneFloats));
    std::memcpy(hits.lanes.d[axis], paths_->d[axis] + first, sizeof(LaneFloats));
  }
  std::memcpy(group.id, ids.data(), ids.size_bytes());
  if (step_.depth == 1 && shading_->has_textures()) widen(first);
  shading_->find_points(*kernels_, ids, hits);
  const Lanes simple = add_simple(first);
  Lanes escaped = 0;
  for (Lanes rest = hits.hit & ~simple; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    if (!step_slowly(first, lane)) escaped |= Lanes{1} << lane;
  }
  return escaped;
}

void Wave::widen(std::size_t first) {
  PathColumns& paths = *paths_;
  std::array<RayGenerator::RowSpacing, kShadingLanes> spacings;
  world_->camera.row_spacings({paths.d[0] + first, paths.d[1] + first, paths.d[2] + first},
                              spacings);
  for (std::size_t lane = 0; lane < kShadingLanes; ++lane) {
    const Footprint footprint = camera_footprint(spacings[lane], step_.sample_width);
    paths.begin[first + lane] = footprint.begin;
    paths.spread[first + lane] = footprint.spread;
  }
}

Lanes Wave::last_paths(std::size_t first) const {
  if (media_.empty()) return step_.depth >= options_.max_depth ? kAllLanes<kShadingLanes> : 0;
  Lanes lanes = 0;
  for (std::size_t k = 0; k < kShadingLanes; ++k) lanes |= Lanes{is_last(first + k)} << k;
  return lanes;
}

Wave::MetSurfaces Wave::add_flat(std::size_t first) {
  VertexGroup& group = vertices_.group();
  const FlatHits& flat = group.hits.flat_hits;
  Lanes lanes = group.hits.flat & group.hits.sure & flat.simple;
  if (lanes == 0) return {};
  shading_->load_surfaces(*kernels_, group.hits, group.surface);
  group.surface_of.fill(nullptr);
  Lanes behind = 0;
  for (int lane = 0; lane < kShadingLanes; ++lane)
    behind |= Lanes{group.hits.lanes.from_behind[lane] != 0} << lane;
  lanes &= ~behind | flat.with_back;
  const auto keep_if = [&](Lanes tested, const auto& condition) {
    for (Lanes rest = lanes & tested; rest != 0; rest &= rest - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(rest));
      if (!condition(first + k)) lanes &= ~(Lanes{1} << k);
    }
  };
  if (looks_behind())
    keep_if(~behind & flat.with_open_back, [&](std::size_t i) { return !may_get_light(i); });
  if (!media_.empty()) keep_if(lanes, [&](std::size_t i) { return paths_->media[i] == 0; });
  const Lanes last = last_paths(first);
  return {.simple = lanes & ~last, .ended = step_.depth > 1 ? lanes & last : 0};
}

bool Wave::is_simple(std::size_t i, const TexturedMaterial& look, bool is_front) const {
  if (!look.is_simple || paths_->media[i] != 0) return false;
  if (!is_front) return look.has_back;
  return !looks_behind() || !look.has_open_back || !may_get_light(i);
}

Lanes Wave::add_simple(std::size_t first) {
  VertexGroup& group = vertices_.group();
  const PathColumns& paths = *paths_;
  const HitLanes& hits = group.hits.lanes;
  for (int lane = 0; lane < kShadingLanes; ++lane) {
    const std::size_t i = first + static_cast<std::size_t>(lane);
    group.width[lane] = paths.begin[i] + paths.spread[i] * hits.distance[lane];
    group.side[lane] = hits.from_behind[lane] != 0 ? -1.0F : 1.0F;
    group.on_mesh[lane] = 1;
    group.normals.is_mapped[lane] = group.coat_normals.is_mapped[lane] = 0;
  }
  auto [simple, ended] = add_flat(first);
  group.plain = simple;
  Lanes varying = 0, last = 0;
  for (Lanes rest = group.hits.sure & ~group.hits.flat; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    const auto k = static_cast<std::size_t>(lane);
    const TexturedMaterial& look = *group.hits.looks[k];
    if (!is_simple(first + k, look, hits.from_behind[lane] == 0)) continue;
    const Lanes bit = Lanes{1} << lane;
    if (is_last(first + k)) {
      if (step_.depth == 1) continue;
      if (look.is_opaque && !look.is_emissive()) ended |= bit;
      if (look.is_opaque || !look.varies) continue;
      last |= bit;
    }
    simple |= bit;
    const BsdfInput& input = *look.constant_but_textures;
    const bool is_plain = input.features.index() == 0;
    if (is_plain) {
      group.plain |= bit;
    } else {
      group.features[k] = input.features;
      for (auto& weights : group.through_weight) weights[lane] = 1;
      group.media[lane] = 0;
      group.channel[lane] = paths.channel[first + k];
    }
    const bool has_colors = !group.hits.meshes[k].arrays->colors.empty();
    if (look.varies || has_colors) varying |= bit;
    // Vertex colors replace the base color, which textures replace each time.
    const TexturedMaterial* const known =
        std::exchange(group.surface_of[k], has_colors ? nullptr : &look);
    if (known == &look) continue;
    put_surface(group.surface, lane, input.parameters);
    if (!is_plain) put_extensions(group.surface, lane, input.parameters, input.layers);
  }
  Lanes passed = 0;
  if (varying != 0) {
    const VaryingSurfaces surfaces = add_varying(first, varying);
    passed = surfaces.passed;
    simple = (simple & ~varying) | surfaces.opaque;
  }
  for (Lanes rest = passed; rest != 0; rest &= rest - 1)
    continue_later(first + static_cast<std::size_t>(std::countr_zero(rest)));
  ended |= simple & last;
  simple &= ~last;
  if (step_.depth == 1) {
    for (Lanes rest = simple; rest != 0; rest &= rest - 1)
      alphas_[paths.slot[first + static_cast<std::size_t>(std::countr_zero(rest))]] = 1;
  }
  group.vertices = simple;
  return simple | ended | passed;
}

Wave::VaryingSurfaces Wave::add_varying(std::size_t first, Lanes lanes) {
  VertexGroup& group = vertices_.group();
  const HitGroup& hits = group.hits;
  for (LaneFloats& channel : textured_.color) std::ranges::fill(channel, 1.0F);
  for (Lanes rest = lanes; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    const auto k = static_cast<std::size_t>(lane);
    if (hits.meshes[k].arrays->colors.empty()) continue;
    const Vec4 color = vertex_color(hits.meshes[k], hits.corners[k], got(hits.lanes.weights, lane));
    for (int channel = 0; channel < 4; ++channel) textured_.color[channel][lane] = color[channel];
  }
  VaryingSurfaces result;
  for (Lanes rest = lanes; rest != 0;) {
    const TexturedMaterial& look = *hits.looks[static_cast<std::size_t>(std::countr_zero(rest))];
    Lanes same = 0;
    for (std::size_t k = 0; k < kShadingLanes; ++k) same |= Lanes{hits.looks[k] == &look} << k;
    same &= rest;
    rest &= ~same;
    const auto& [from_camera, from_others] = *look.kernel_surfaces;
    const TexturedSurface& surface = step_.depth == 1 ? from_camera : from_others;
    set_least_alpha(first, look, surface.covering_alpha);
    kernels_->load_textured(surface, same, hits.lanes, group.width, textured_, group.surface,
                            group.normals);
    result.opaque |= textured_.opaque;
    if (look.material->alpha_mode == AlphaMode::blend && passed_ < kMostPassed)
      result.passed |= same & ~textured_.covers;
    if (look[MaterialTexture::normal].map == nullptr) continue;
    for (Lanes mapped = textured_.opaque; mapped != 0; mapped &= mapped - 1) {
      const int lane = std::countr_zero(mapped);
      const auto k = static_cast<std::size_t>(lane);
      group.normals.is_mapped[lane] = 1;
      put_tangents(group, lane, hits.meshes[k], hits.corners[k]);
    }
  }
  return result;
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
  const BsdfInput& whole = shading_->bsdf_input(point, channel, beyond.outside, varying_);
  const BsdfInput& input =
      point.look->is_clear
          ? varying_.emplace(bsdf::without_transmission(whole.parameters), whole.layers)
          : whole;
  group.vertices |= Lanes{1} << lane;
  group.id[lane] = hit.id;
  put_point(group, lane, point);
  group.surface_of[k] = nullptr;
  put_surface(group.surface, lane, input.parameters);
  if (input.features.index() == 0) {
    group.plain |= Lanes{1} << lane;
    return;
  }
  group.plain &= ~(Lanes{1} << lane);
  group.features[k] = input.features;
  put_extensions(group.surface, lane, input.parameters, input.layers);
  group.channel[lane] = static_cast<std::uint32_t>(channel);
  Vec3 through(1);
  if (paths_->channel[i] != group.channel[lane]) {
    // A dispersive surface reduces the path to one channel.
    Vec3 only(0);
    only[channel] = 3;
    if (may_reflect_totally(point, beyond.outside)) {
      put_vector(paths_->throughput, i, vector_of(paths_->throughput, i) * only);
      paths_->channel[i] = group.channel[lane];
    } else {
      through = only;
    }
  }
  put(group.through_weight, lane, through);
  group.media[lane] = NestedMediaTable::number_of(beyond.media);
}

}  // namespace microtrace
