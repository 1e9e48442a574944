/// The triangles that rays pass through in places because of their alpha.

#include "base/memory_account.hpp"
#include "render/kernels/find_points.hpp"
#include "render/shading/hit_lanes.hpp"
#include "render/shading/shading.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// The weights of the vertices of a triangle at a ray's hit, without the point. Let T be the sum of
/// |o_i|, of the components of a - o, and of those of the edges, all without signs, E the sum of
/// those of the edges, and D that of |d_i|. The errors of the weights are below 2^-48 T E D /
/// |size|. Those of PlanePoints are greatest where t is uncertain: the error of t is below 2^-47 T
/// E^2 / |size| and changes the weights by at most E D^2 / |size| per unit of t. So if T E D is
/// below 2^14 |size|, both together, rounded to float32, are below 2^-17.
struct QuickWeights {
  float second, third;
  bool are_sure;

  QuickWeights(const Triangle& of, const Ray& ray) {
    const DVec3 o(ray.o), d(ray.d), first(of.a);
    const DVec3 a = first - o, e1 = DVec3(of.b) - first, e2 = DVec3(of.c) - first;
    const DVec3 r = glm::cross(a, d);
    const double size = glm::dot(glm::cross(e1, e2), d), inverse = 1 / size;
    second = static_cast<float>(glm::dot(e2, r) * inverse);
    third = static_cast<float>(-glm::dot(e1, r) * inverse);
    const double edges = magnitudes_sum(e1) + magnitudes_sum(e2);
    const double all = magnitudes_sum(o) + magnitudes_sum(a) + edges;
    are_sure = all * edges * magnitudes_sum(d) < 0x1p14 * std::abs(size);
  }
};
static_assert(0x1p-17 < OpacityMaps::kTolerance);

}  // namespace

void Shading::find_masked() {
  for (Entry& entry : entries_) {
    const Material& material = *looks_[entry.look].material;
    // Bodies that enclose a medium may hide each other's surfaces, so each hit matters.
    if (entry.mesh == nullptr || material.alpha_mode == AlphaMode::opaque ||
        encloses_medium(material))
      continue;
    if (masked_.empty()) {
      take_memory(primitives_.count() / 8, "the transparent surfaces of the scene");
      masked_.resize(bit_set_size(primitives_.count()));
    }
    const auto end = entry.first_id + static_cast<PrimitiveId>(entry.mesh->triangles.size());
    entry.first_map = opacity_.add(*entry.mesh, looks_[entry.look]);
    for (PrimitiveId id = entry.first_id; id < end; ++id) {
      if (opacity_.everywhere(entry.first_map + (id - entry.first_id)) != Opacity::visible)
        insert(masked_.data(), id);
    }
  }
  opacity_.finish();
  if (std::ranges::count(masked_, 0U) == std::ssize(masked_)) masked_.clear();
}

/// A ray's point in the plane of a masked triangle.
struct Shading::MaskedHit {
  const Entry& entry;
  std::size_t triangle;
  std::array<std::uint32_t, 3> corners;
  PlanePoints<1> plane;

  MaskedHit(const Entry& of, const Ray& ray, PrimitiveId id)
      : entry(of),
        triangle(id - entry.first_id),
        corners(entry.mesh->corners(triangle)),
        plane({DVec3(ray.o), DVec3(ray.d)}, {position(0), position(1), position(2)}) {}

  [[nodiscard]] Vec3 barycentrics() const { return Vec3(plane.weights(1 / plane.square)); }

 private:
  [[nodiscard]] DVec3 position(std::size_t corner) const {
    return DVec3(entry.mesh->position(corners[corner]));
  }
};

bool Shading::is_transparent(const Ray& ray, PrimitiveId id) const {
  const Entry& entry = entries_[primitives_.object_index(id)];
  const std::size_t triangle = id - entry.first_id;
  const QuickWeights weights(triangle_of(*entry.mesh, triangle), ray);
  const Opacity known = weights.are_sure
                            ? opacity_.at(entry.first_map + triangle, weights.second, weights.third)
                            : Opacity::unknown;
  return known == Opacity::unknown ? look_up_transparent(entry, ray, id)
                                   : known == Opacity::transparent;
}

bool Shading::look_up_transparent(const Entry& entry, const Ray& ray, PrimitiveId id) const {
  const MaskedHit hit(entry, ray, id);
  if (!hit.plane.are_sure()) return is_transparent(point(ray, {.id = id, .t = 0}).unfiltered());
  ShadingPoint point{.at = {}, .look = &looks_[entry.look]};
  point.at.mesh = entry.mesh;
  point.at.corners = hit.corners;
  point.at.barycentrics = hit.barycentrics();
  point.at.find_first_uv();
  return is_transparent(point);
}

bool Shading::is_transparent(const ShadingPoint& point) {
  return coverage(*point.look->material, base_color(point).w) == 0;
}

bool Shading::is_transparent_to_camera(const Ray& ray, PrimitiveId id,
                                       const Footprint& footprint) const {
  const MaskedHit hit(entries_[primitives_.object_index(id)], ray, id);
  if (!hit.plane.are_sure()) return false;
  const TexturedMaterial& look = looks_[hit.entry.look];
  if (hit.plane.slope > 0 && !look.has_back) return true;
  const Vec3 weights = hit.barycentrics();
  const Opacity known = opacity_.at(hit.entry.first_map + hit.triangle, weights.y, weights.z);
  const double distance = hit.plane.t * std::sqrt(glm::dot(hit.plane.d, hit.plane.d));
  const double width = footprint.begin + footprint.spread * distance;
  if (known != Opacity::unknown &&
      look[MaterialTexture::base_color].is_magnified(*hit.entry.mesh, hit.corners,
                                                     width * width / std::sqrt(hit.plane.square)))
    return known == Opacity::transparent;
  ShadingPoint point = this->point(ray, {.id = id, .t = 0});
  point.width = footprint.begin + footprint.spread * point.at.distance;
  return coverage(point, true) == 0;
}

}  // namespace microtrace
