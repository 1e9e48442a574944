#include "render/shading/shading.hpp"

#include "render/bsdf/ggx.hpp"
#include "render/shading/texture_slots.hpp"
#include "scene/math/luminance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

const Material kNoMaterial{};

bool transmits(const Material& m) {
  return m.transmission && m.transmission->factor > 0;
}

bool transmits_diffusely(const Material& m) {
  return m.diffuse_transmission && m.diffuse_transmission->factor > 0;
}

/// True if light passes the back regardless of options, except where a texture makes the surface
/// opaque. A path that enters and leaves one-sided thin glass crosses one wall instead of two, just
/// as camera rays do.
bool is_thin_glass(const Material& m) {
  return transmits(m) && !has_back(m);
}

/// True if every ray that passes the back of the shape arrives at its front, where it is blocked,
/// or the reverse. Queries return only the first of the two hits.
bool is_closed(const Shape& shape) {
  return std::holds_alternative<Sphere>(shape) || std::holds_alternative<Quadric>(shape);
}

bool has_map(const TextureSlot& slot) {
  return slot.map != nullptr;
}

/// True if all light that the surface transmits goes straight on. The base of a metal isn't
/// transmitted, but reflected.
bool is_clear(const Material& m) {
  return transmits(m) && !transmits_diffusely(m) && !encloses_medium(m) && !is_emissive(m) &&
         !m.unlit && !m.anisotropy && !m.specular_glossiness && m.metallic == 0 &&
         m.roughness * m.roughness <= bsdf::kLeastAlpha;
}

void set_opacity(TexturedMaterial& look) {
  const AlphaMode mode = look.material->alpha_mode;
  look.depends_on_alpha = !is_thin_glass(*look.material) && !look.has_open_opaque_parts;
  look.is_clear = is_clear(*look.material);
  look.is_opaque_if_visible = look.depends_on_alpha && mode != AlphaMode::blend && !look.is_clear;
  look.is_opaque = look.is_opaque_if_visible && mode == AlphaMode::opaque;
}

bool is_missing_back(const ShadingPoint& point) {
  return !point.at.front && !has_back(*point.look->material);
}

}  // namespace

bool TexturedMaterial::has_rare_textures() const {
  const auto count = static_cast<std::size_t>(std::ranges::count_if(slots, has_map));
  const auto frequent = std::ranges::count_if(kFrequent, [&](MaterialTexture texture) {
    return has_map((*this)[texture]) && (*this)[texture].use->uv_set == 0;
  });
  return count != static_cast<std::size_t>(frequent);
}

void TexturedMaterial::fetch(const TexelAddress<1>& address) const {
  for (const MaterialTexture texture : kFrequent) {
    const TextureSlot& slot = (*this)[texture];
    if (slot.shares_address) slot.map->fetch(address);
  }
}

Shading::Shading(const Scene& scene, const Primitives& primitives, SharedTextures& textures)
    : primitives_(primitives),
      maps_(std::make_unique<TextureMaps>(scene, textures)),
      with_open_backs_(primitives.count(), "the one-sided surfaces of the scene"),
      masked_(primitives.count(), "the transparent surfaces of the scene") {
  const auto add = [&](const Material& material) {
    TexturedMaterial& look = looks_.emplace_back(maps_->slots(material));
    look.has_constant_emission = look[MaterialTexture::emissive].map == nullptr &&
                                 material.alpha_mode == AlphaMode::opaque && !material.unlit;
    const bool may_have_open_back = !has_back(material) && !look.is_emissive();
    look.has_open_back =
        may_have_open_back && !transmits(material) && !transmits_diffusely(material);
    look.has_open_opaque_parts =
        may_have_open_back && !look.has_open_back &&
        (!transmits(material) || has_map(look[MaterialTexture::transmission])) &&
        (!transmits_diffusely(material) || has_map(look[MaterialTexture::diffuse_transmission]));
    look.is_textured = std::ranges::any_of(look.slots, has_map);
    look.has_back = has_back(material);
    set_opacity(look);
    has_textures_ |= look.is_textured;
    // Anisotropy depends on tangents, and the boundary of a medium on the side of the ray.
    if (look.has_rare_textures() || material.anisotropy || encloses_medium(material)) return;
    TexturedMaterial white = look;
    white.slots = {};
    const ShadingPoint anywhere{.at = {}, .look = &white};
    look.constant_but_textures.emplace(parameters(anywhere, 3, nullptr), layers(anywhere));
    const bool may_be_dark = !look.is_emissive() || look[MaterialTexture::emissive].map != nullptr;
    look.is_simple =
        !material.unlit && may_be_dark && !material.specular_glossiness && !look.is_clear;
    look.varies = look.is_textured || material.alpha_mode != AlphaMode::opaque;
    if (look.varies) set_kernel_surfaces(look);
  };
  for (const Material& material : scene.materials) add(material);
  add(kNoMaterial);
  std::vector<std::optional<std::uint32_t>> closed(looks_.size());  // looks of closed shapes
  for (const ObjectRun& run : scene.objects.runs()) {
    const Object& object = *run.first;
    const auto none = static_cast<std::uint32_t>(scene.materials.size());
    std::uint32_t look = object.material.value_or(none);
    if ((looks_[look].has_open_back || looks_[look].has_open_opaque_parts) &&
        is_closed(object.shape)) {
      if (!closed[look]) {
        closed[look] = static_cast<std::uint32_t>(looks_.size());
        TexturedMaterial copy = looks_[look];
        copy.has_open_back = copy.has_open_opaque_parts = false;
        set_opacity(copy);
        looks_.push_back(copy);
      }
      look = *closed[look];
    }
    const Mesh* const mesh = std::get_if<Mesh>(&object.shape);
    if (mesh != nullptr && !mesh->colors.empty()) set_kernel_surfaces(looks_[look]);
    entries_.push_back({.mesh = mesh,
                        .placements = run.placements,
                        .first_id = primitives.first_id_of_run(entries_.size()),
                        .look = look});
    all_cover_ &= looks_[entries_.back().look].is_opaque;
    has_open_backs_ |= looks_[entries_.back().look].has_open_back;
  }
  for (const TexturedMaterial& look : looks_) flat_triangles_.add_surface(look);
  for (std::size_t run = 0; run < entries_.size(); ++run)
    for_each_mesh(run, [&](const PlacedMesh& mesh, PrimitiveId first_id) {
      const std::uint32_t look = entries_[run].look;
      flat_triangles_.add_mesh(mesh, first_id, look, looks_[look]);
    });
  if (has_open_backs_) find_open_backs();
  find_masked();
}

void Shading::find_open_backs() {
  for (std::size_t run = 0; run < entries_.size(); ++run) {
    const Entry& entry = entries_[run];
    if (!looks_[entry.look].has_open_back) continue;
    if (entry.mesh == nullptr) {
      with_open_backs_.clear();
      return;
    }
    with_open_backs_.insert(entry.first_id, primitives_.first_id_of_run(run + 1));
  }
}

Shading::~Shading() = default;

ShadingPoint Shading::point(const Ray& ray, const Hit& hit) const {
  const Entry& entry = entry_of(hit.id);
  const MeshTriangle triangle = entry.triangle(hit.id);
  return {.at = surface_point(primitives_, ray, hit, triangle.mesh, triangle.index),
          .look = &looks_[entry.look]};
}

ShadingPoint Shading::point_on(PrimitiveId id, const Vec3& barycentrics, bool front,
                               float width) const {
  const Entry& entry = entry_of(id);
  const MeshTriangle triangle = entry.triangle(id);
  return {.at = triangle.mesh ? surface_point(triangle.mesh, triangle.index, barycentrics, front)
                              : SurfacePoint{.front = front},
          .look = &looks_[entry.look],
          .width = width};
}

ShadingPoint Shading::texture_point(PrimitiveId id, const Vec3& barycentrics) const {
  const Entry& entry = entry_of(id);
  const MeshTriangle triangle = entry.triangle(id);
  return {.at = microtrace::texture_point(triangle.mesh, triangle.index, barycentrics),
          .look = &looks_[entry.look]};
}

void Shading::find_texel_address(ShadingPoint& point) {
  const TexturedMaterial& look = *point.look;
  if (look.layout.map == nullptr) return;
  point.texel_address = look.layout.texel_address(point);
  look.fetch(*point.texel_address);
}

Vec4 Shading::base_color(const ShadingPoint& point) {
  return point.look->material->base_color * point.at.color() *
         (*point.look)[MaterialTexture::base_color].at(point);
}

float Shading::coverage(const ShadingPoint& point, bool from_camera) const {
  const Material& material = *point.look->material;
  if (is_missing_back(point) && (from_camera || (is_thin_glass(material) && !lacks_glass(point))))
    return 0;
  if (material.alpha_mode == AlphaMode::opaque) return 1;
  return coverage(material, base_color(point).w);
}

bool Shading::lacks_glass(const ShadingPoint& point) {
  const TextureSlot& slot = (*point.look)[MaterialTexture::transmission];
  return !transmits(*point.look->material) ||
         (slot.map != nullptr && slot.at(point.unfiltered()).x == 0);
}

bool Shading::is_opaque_part(const ShadingPoint& point) {
  const TextureSlot& slot = (*point.look)[MaterialTexture::diffuse_transmission];
  return lacks_glass(point) && (!transmits_diffusely(*point.look->material) ||
                                (slot.map != nullptr && slot.at(point.unfiltered()).w == 0));
}

float Shading::coverage(const Material& material, float alpha) {
  if (material.alpha_mode == AlphaMode::opaque) return 1;
  if (material.alpha_mode == AlphaMode::mask) return alpha >= covering_alpha(material) ? 1 : 0;
  return std::clamp(alpha, 0.0F, 1.0F);
}

float Shading::covering_alpha(const Material& material) {
  if (material.alpha_mode == AlphaMode::opaque) return -std::numeric_limits<float>::infinity();
  return material.alpha_mode == AlphaMode::mask ? material.alpha_cutoff : 1;
}

Vec3 Shading::emission(const ShadingPoint& point) const {
  const TexturedMaterial& look = *point.look;
  if (is_missing_back(point)) return Vec3(0);
  const Vec3 unlit = look.material->unlit ? Vec3(base_color(point)) : Vec3(0);
  const Vec3 color = look.material->emissive;
  if (color == Vec3(0)) return unlit;
  return unlit +
         glm::min(color, Vec3(kBrightest)) * Vec3(look[MaterialTexture::emissive].at(point));
}

}  // namespace microtrace
