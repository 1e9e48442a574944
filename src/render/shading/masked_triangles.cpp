/// The triangles that rays pass through in places because of their alpha.

#include "render/shading/points/find_points.hpp"
#include "render/shading/points/hit_lanes.hpp"
#include "render/shading/shading.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace {

void Shading::find_masked() {
  for (std::size_t run = 0; run < entries_.size(); ++run) {
    Entry& entry = entries_[run];
    const Material& material = *looks_[entry.look].material;
    // Bodies that enclose a medium may hide each other's surfaces, so each hit matters.
    const TexturedMaterial& look = looks_[entry.look];
    const bool is_solid = material.alpha_mode == AlphaMode::opaque && !look.is_clear;
    if (entry.mesh == nullptr || is_solid || encloses_medium(material)) continue;
    has_blended_ |= blends(look);
    // Queries for paths pass all of these, those for light only those that blend.
    const bool is_partial = look.is_clear || material.alpha_mode == AlphaMode::blend;
    for_each_mesh(run, [&](const PlacedMesh& mesh, PrimitiveId first_id) {
      std::size_t& first_map = entry.first_map_of(mesh);
      if (first_map == kNoMap) first_map = opacity_.add(mesh, look);
      for (std::size_t i = 0; i < mesh.arrays->triangles.size(); ++i) {
        const PrimitiveId id = first_id + static_cast<PrimitiveId>(i);
        if (is_partial || opacity_.everywhere(first_map + i) != Opacity::visible)
          masked_.insert(id, id + 1);
      }
    });
  }
  opacity_.finish();
}

/// A ray's point in the plane of a masked triangle.
struct Shading::MaskedHit {
  const Entry& entry;
  MeshTriangle triangle;
  std::array<std::uint32_t, 3> corners;
  PlanePoints<1> plane;

  MaskedHit(const Entry& of, const Ray& ray, PrimitiveId id)
      : entry(of),
        triangle(of.triangle(id)),
        corners(triangle.mesh.corners(triangle.index)),
        plane({DVec3(ray.o), DVec3(ray.d)}, {position(0), position(1), position(2)}) {}

  [[nodiscard]] Vec3 barycentrics() const { return Vec3(plane.weights(1 / plane.square)); }

 private:
  [[nodiscard]] DVec3 position(std::size_t corner) const {
    return DVec3(triangle.mesh.position(corners[corner]));
  }
};

Visible Shading::known_visible(PrimitiveId id, const HitWeights& at) const {
  static_assert(HitWeights::kError < OpacityMaps::kTolerance);
  if (!at.are_sure) return Visible::unsure;
  const Entry& entry = entry_of(id);
  switch (opacity_.at(entry.map(entry.triangle(id)), at.second, at.third)) {
    case Opacity::transparent:
      return Visible::no;
    case Opacity::visible:
      return Visible::yes;
    default:
      return Visible::unsure;
  }
}

float Shading::masked_coverage(const Ray& ray, PrimitiveId id) const {
  const Entry& entry = entry_of(id);
  const MaskedHit hit(entry, ray, id);
  if (!hit.plane.are_sure()) return alpha_coverage(point(ray, {.id = id, .t = 0}).unfiltered());
  ShadingPoint point{.at = {}, .look = &looks_[entry.look]};
  point.at.mesh = hit.triangle.mesh;
  point.at.corners = hit.corners;
  point.at.barycentrics = hit.barycentrics();
  point.at.find_first_uv();
  return alpha_coverage(point);
}

float Shading::alpha_coverage(const ShadingPoint& point) {
  return coverage(*point.look->material, base_color(point).w);
}

bool Shading::is_transparent_to_camera(const Ray& ray, PrimitiveId id,
                                       const Footprint& footprint) const {
  const MaskedHit hit(entry_of(id), ray, id);
  const TexturedMaterial& look = looks_[hit.entry.look];
  if (look.has_back && opacity_.everywhere(hit.entry.map(hit.triangle)) == Opacity::visible)
    return false;
  if (!hit.plane.are_sure()) return false;
  if (hit.plane.slope > 0 && !look.has_back) return true;
  const Vec3 weights = hit.barycentrics();
  const Opacity known = opacity_.at(hit.entry.map(hit.triangle), weights.y, weights.z);
  const double distance = hit.plane.t * std::sqrt(glm::dot(hit.plane.d, hit.plane.d));
  const double width = footprint.begin + footprint.spread * distance;
  if (known != Opacity::unknown &&
      look[MaterialTexture::base_color].is_magnified(*hit.triangle.mesh.arrays, hit.corners,
                                                     width * width / std::sqrt(hit.plane.square)))
    return known == Opacity::transparent;
  ShadingPoint point = this->point(ray, {.id = id, .t = 0});
  point.width = footprint.begin + footprint.spread * point.at.distance;
  return coverage(point, true) == 0;
}

}  // namespace microtrace
