#include "render/aovs/sights.hpp"

#include "accel/intersect_fronts.hpp"
#include "render/shading/surfaces.hpp"
#include "scene/surface/surface_finder.hpp"

#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace {

static_assert(kRegularBatch == kSurfaceLanes);

Sights::Sights(const World& world, std::span<const Ray> rays, const AovSet& aovs)
    : world_(world), rays_(rays) {
  const std::span<std::optional<Hit>> hits = std::span(hits_).first(rays.size());
  intersect_fronts(world.bvh, rays, world.open_backs, hits);
  const auto find_seen = [&] {
    seen_ = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) seen_ |= std::uint64_t{hits[i].has_value()} << i;
  };
  find_seen();
  if (seen_ == 0) return;
  const SurfaceFinder& finder = world.surfaces.finder();
  const SurfaceParts parts{
      .n = aovs.has(Aov::face_normal), .ns = aovs.has(Aov::normal), .uv = aovs.has(Aov::uv)};
  const auto find = [&] {
    if (aovs.needs_surfaces())
      finder.find(rays, hits, parts, surfaces_);
    else
      finder.find_ids(hits, surfaces_);
  };
  find();
  // Most hits are on surfaces that are visible from the ray's side.
  bool is_changed = false;
  for (std::uint64_t left = seen_; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left));
    const Visibility visibility = world.surfaces.visibility(hits[i]->id);
    if (visibility == Visibility::always ||
        (visibility == Visibility::in_front && aovs.needs_surfaces() && surfaces_.side[i] > 0))
      continue;
    const PrimitiveId first = hits[i]->id;
    hits[i] = world.first_visible(rays[i], hits[i]);
    is_changed = is_changed || !hits[i] || hits[i]->id != first;
  }
  if (!is_changed) return;
  find();
  find_seen();
}

void Sights::values_of(Aov aov, Values<float>& values) const {
  const float none = value_of_nothing(aov);
  if (seen_ == 0) {
    for (auto& channel : values) channel.fill(none);
    return;
  }
  const SurfaceBatch& at = surfaces_;
  // Computes all lanes, because this is faster than selecting the lanes with hits.
  const auto set = [&](std::size_t channels, const auto& value) {
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t i = 0; i < kSize; ++i) values[c][i] = value(c, i);
    }
  };
  const auto point = [&](std::size_t i) { return DVec3(at.p[0][i], at.p[1][i], at.p[2][i]); };
  switch (aov) {
    case Aov::depth:
      world_.camera.depths(at.p[0], at.p[1], at.p[2], values[0]);
      break;
    case Aov::distance:
      for (std::size_t i = 0; i < rays_.size(); ++i) {
        const DVec3 way = point(i) - DVec3(rays_[i].o);
        values[0][i] = static_cast<float>(std::sqrt(glm::dot(way, way)));
      }
      break;
    case Aov::position: {
      const DVec3 origin = world_.scene.origin;
      const std::array offset{origin.x, origin.y, origin.z};
      set(3,
          [&](std::size_t c, std::size_t i) { return static_cast<float>(at.p[c][i] + offset[c]); });
      break;
    }
    case Aov::normal:
      set(3, [&](std::size_t c, std::size_t i) { return at.side[i] * at.ns[c][i]; });
      break;
    case Aov::face_normal:
      set(3, [&](std::size_t c, std::size_t i) { return at.side[i] * at.n[c][i]; });
      break;
    case Aov::uv:
      set(2, [&](std::size_t c, std::size_t i) { return at.uv[c][i]; });
      break;
    case Aov::barycentric:
      set(3, [&](std::size_t c, std::size_t i) { return at.barycentrics[c][i]; });
      break;
    case Aov::albedo:
      for (std::size_t i = 0; i < rays_.size(); ++i) {
        if (!hits_[i]) continue;
        const Vec3* plain = world_.surfaces.plain_color(rays_[i], *hits_[i]);
        const Vec3 color = plain != nullptr ? *plain : Vec3(world_.base_color(rays_[i], *hits_[i]));
        for (glm::length_t c = 0; c < 3; ++c) values[static_cast<std::size_t>(c)][i] = color[c];
      }
      break;
    case Aov::id:
      break;
  }
  if (is_all_seen()) return;
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    if (!is_seen(i)) values[0][i] = values[1][i] = values[2][i] = none;
  }
}

void Sights::ids(std::size_t channel, std::array<std::uint32_t, kSize>& values) const {
  const Objects& objects = world_.scene.objects;
  const auto set = [&](const auto& id) {
    for (std::size_t i = 0; i < rays_.size(); ++i) values[i] = is_seen(i) ? id(i) : 0;
  };
  if (channel == 0) {
    set([&](std::size_t i) { return surfaces_.object[i] + 1; });
  } else if (channel == 1) {
    set([&](std::size_t i) { return surfaces_.primitive[i] + 1; });
  } else {
    set([&](std::size_t i) {
      const std::optional<std::uint32_t> material = objects.first_of(surfaces_.object[i]).material;
      return material ? *material + 1 : 0;
    });
  }
}

}  // namespace microtrace
