/// The paths of a wavefront that need further tests where they meet surfaces.

#include "render/integrators/wavefront/medium_event.hpp"
#include "render/integrators/wavefront/wave.hpp"
#include "render/media/beer_lambert.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace microtrace {

void Wave::prepare(std::size_t i, ShadingPoint& point) const {
  point.width = paths_->begin[i] + paths_->spread[i] * point.at.distance;
  Shading::find_texel_address(point);
}

bool Wave::step_slowly(std::size_t first, int lane) {
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
  std::uint32_t passed = passed_;
  bool is_nearest = true;
  crossed_.clear();
  const auto weaken_by_glass = [&] {
    for (const Crossed& crossed : crossed_) weaken(i, crossed.light);
  };
  while (hit && (passes_hidden_surface(i, point) || !stops(i, point, passed))) {
    if (from_camera && !crossed_.empty()) alphas_[paths.slot[i]] = 1;
    if (is_nearest && passed > passed_ && may_continue_later(i)) {
      weaken_by_glass();
      continue_later(i);
      return true;
    }
    hit = next(i, *hit, point);
    is_nearest = false;
  }
  if (paths.media[i] != 0) {
    if (!cross_medium(i, ray, hit, point.at.distance)) return true;
  } else {
    weaken_by_glass();
  }
  if (!hit) return false;
  if (looks_behind() && Shading::lets_light_in(point) &&
      (!is_nearest || !point.look->has_open_back || may_get_light(i))) {
    const Behind behind = look_behind(i, *hit, point, passed, is_nearest);
    if (behind.is_open || behind.hit) weaken(i, behind.light);
    const NestedMedia* media = media_.at(paths.media[i]);
    // No light arrives from infinitely far away through a medium that scatters.
    if (behind.is_open) return media != nullptr && media->medium->scatters();
    if (behind.hit && media != nullptr) {
      const float rest = behind.point.at.distance - point.at.distance;
      weaken(i, beer_lambert(media->medium->extinction, rest));
    }
    if (behind.hit) hit = behind.hit, point = behind.point;
  }
  if (from_camera) alphas_[paths.slot[i]] = 1;
  add_emission(i, *hit, point);
  if (!is_last(i) && !point.look->material->unlit) put_vertex(i, lane, *hit, point);
  return true;
}

void Wave::weaken(std::size_t i, const Vec3& light) {
  if (light != Vec3(1)) put_vector(paths_->throughput, i, vector_of(paths_->throughput, i) * light);
}

bool Wave::stops(std::size_t i, const ShadingPoint& point, std::uint32_t& passed) {
  // The other paths find the reflected light. Their number limits its factor.
  constexpr float kMostCrossing = 0.999F;
  const bool from_camera = paths_->pdf[i] == 0;
  const TexturedMaterial& look = *point.look;
  if (!from_camera && look.is_opaque) return true;
  const ShadingPoint at = from_camera ? point : point.unfiltered();
  const float coverage = shading_->coverage(at, from_camera);
  if (coverage == 0 || (coverage == 1 && !look.is_clear)) return coverage == 1;
  const float u = paths_->sobol(i).one(coverage_pair(passed));
  if (u < coverage) {
    if (!look.is_clear) return true;
    const Vec3 light = shading_->crossing_light(at, vector_of(paths_->d, i), options_.bsdf);
    const float part = std::min(std::max({light.x, light.y, light.z}), kMostCrossing);
    const bool stops = !(u < coverage * part);
    crossed_.push_back(
        {.distance = point.at.distance, .light = stops ? Vec3(1 / (1 - part)) : light / part});
    if (stops) return true;
  }
  ++passed;
  return false;
}

std::optional<Hit> Wave::next(std::size_t i, const Hit& hit, ShadingPoint& point) {
  ++counts_.beyond;
  const Ray ray = paths_->ray(i);
  const std::optional<Hit> result = world_->bvh.next(ray, hit);
  if (!result) return result;
  point = shading_->point(ray, *result);
  prepare(i, point);
  return result;
}

Wave::Behind Wave::look_behind(std::size_t i, const Hit& first, ShadingPoint point,
                               std::uint32_t passed, bool is_nearest) {
  const auto is_sky_lit = [&] {
    return lighting_->environment(unit<1>(vector_of(paths_->d, i))) != Vec3(0);
  };
  if (is_nearest && point.look->has_open_back && knows_blocked() && blockers_[i] == kNoPrimitive)
    return {.is_open = is_sky_lit()};
  std::optional<Hit> hit = first;
  const std::size_t before = crossed_.size();
  const auto light = [&] {
    Vec3 product(1);
    for (const Crossed& crossed : std::span(crossed_).subspan(before)) product *= crossed.light;
    return product;
  };
  while (Shading::lets_light_in(point)) {
    ++passed;
    do {
      hit = next(i, *hit, point);
      if (!hit) return {.is_open = is_sky_lit(), .light = light()};
    } while (!stops(i, point, passed));
  }
  if (!point.look->is_emissive() || emission(i, point) == Vec3(0)) return {};
  return {.light = light(), .hit = hit, .point = point};
}

bool Wave::passes_hidden_surface(std::size_t i, const ShadingPoint& point) {
  const NestedMedia* here = media_.at(paths_->media[i]);
  if (here == nullptr) return false;
  const Medium* own = Shading::enclosed_medium(point);
  if (!NestedMediaTable::is_hidden(own, point.at.front, here)) return false;
  crossed_.push_back({.distance = point.at.distance, .left = own});
  return true;
}

bool Wave::cross_medium(std::size_t i, const Ray& ray, const std::optional<Hit>& hit,
                        float distance) {
  PathColumns& paths = *paths_;
  const NestedMedia* media = media_.at(paths.media[i]);
  MediumPath path{.sobol = paths.sobol(i),
                  .throughput = vector_of(paths.throughput, i),
                  .pdf = paths.pdf[i],
                  .begin = paths.begin[i],
                  .spread = paths.spread[i],
                  .scatterings = paths.scatterings[i]};
  const MediumEvent event =
      microtrace::cross_medium(world_->bvh, step_, ray, hit, distance, *media->medium, path);
  for (const Crossed& crossed : crossed_) {
    if (!event.arrives && !(crossed.distance < event.distance)) continue;
    path.throughput *= crossed.light;
    if (crossed.left != nullptr) media = media_.without(media, *crossed.left);
  }
  put_vector(paths.throughput, i, path.throughput);
  paths.media[i] = NestedMediaTable::number_of(media);
  if (!event.scattered) return event.arrives;
  PathColumns& next = *next_paths_;
  const std::size_t k = outgoing_->count++;
  put_vector(next.o, k, event.scattered->o);
  put_vector(next.d, k, event.scattered->d);
  next.left[k] = kNoPrimitive;
  next.key[k] = paths.key[i];
  next.index[k] = paths.index[i];
  next.slot[k] = paths.slot[i];
  put_vector(next.throughput, k, path.throughput);
  next.pdf[k] = path.pdf;
  put_vector(next.from_p, k, vector_of(paths.from_p, i));
  put_vector(next.from_n, k, vector_of(paths.from_n, i));
  next.media[k] = paths.media[i];
  next.scatterings[k] = path.scatterings;
  next.is_scattered[k] = 1;
  next.channel[k] = paths.channel[i];
  next.begin[k] = path.begin;
  next.spread[k] = path.spread;
  return false;
}

}  // namespace microtrace
