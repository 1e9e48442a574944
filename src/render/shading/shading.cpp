#include "render/shading/shading.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

const Material kNoMaterial{};

TextureMap::Place place_of(const TextureMap& map, const TextureUse& use,
                           const ShadingPoint& point) {
  const Vec2 uv = point.at.uv(use.uv_set);
  const auto& m = use.texture_from_uv;
  const float scale = std::sqrt(std::abs(m[0].x * m[1].y - m[0].y * m[1].x));
  return map.place(m[0] * uv.x + m[1] * uv.y + m[2], point.width * point.at.uv_scale * scale);
}

Vec4 look_up(const TextureMap& map, const TextureUse& use, const ShadingPoint& point) {
  return map.sample(point.place ? *point.place : place_of(map, use, point));
}

/// Sets the layout if all textures share one.
void compare_layouts(TexturedMaterial& look) {
  const Material& m = *look.material;
  bool same = true;
  const auto compare = [&](const TextureMap* map, const std::optional<TextureUse>& use) {
    if (map == nullptr) return;
    if (look.layout == nullptr) {
      look.layout = map;
      look.layout_use = &*use;
    }
    same = same && map->is_laid_out_as(*look.layout) && use->uv_set == look.layout_use->uv_set &&
           use->texture_from_uv == look.layout_use->texture_from_uv;
  };
  compare(look.base_color, m.base_color_texture);
  compare(look.metallic_roughness, m.metallic_roughness_texture);
  compare(look.normal, m.normal_texture);
  compare(look.emissive, m.emissive_texture);
  if (!same) look.layout = nullptr;
}

/// The normal nearest to n above whose horizon wo is, just.
Vec3 turned_towards(const Vec3& n, const Vec3& wo) {
  constexpr float least = 0.01F;
  const float cosine = glm::dot(n, wo);
  if (cosine >= least) return n;
  return bsdf::unit(n + (least - cosine) * wo);
}

}  // namespace

/// By texture and encoding.
struct Shading::Maps {
  const TextureMap* get(const Scene& scene, const std::optional<TextureUse>& use,
                        ColorEncoding encoding) {
    if (!use) return nullptr;
    const Texture& texture = scene.textures[use->texture];
    if (!texture.image || !scene.images[*texture.image]) return nullptr;
    return &maps.try_emplace({use->texture, encoding}, *scene.images[*texture.image],
                             texture.sampler, encoding)
                .first->second;
  }

  std::map<std::pair<std::uint32_t, ColorEncoding>, TextureMap> maps;
};

Shading::Shading(const Scene& scene, const Primitives& primitives)
    : primitives_(primitives), maps_(std::make_unique<Maps>()) {
  const auto add = [&](const Material& m) {
    looks_.push_back({.material = &m,
                      .base_color = maps_->get(scene, m.base_color_texture, ColorEncoding::srgb),
                      .metallic_roughness =
                          maps_->get(scene, m.metallic_roughness_texture, ColorEncoding::linear),
                      .normal = maps_->get(scene, m.normal_texture, ColorEncoding::linear),
                      .emissive = maps_->get(scene, m.emissive_texture, ColorEncoding::srgb)});
    compare_layouts(looks_.back());
  };
  for (const Material& material : scene.materials) add(material);
  add(kNoMaterial);
  PrimitiveId first = 0;
  for (const Object& object : scene.objects) {
    const auto none = static_cast<std::uint32_t>(scene.materials.size());
    entries_.push_back({.mesh = std::get_if<Mesh>(&object.shape),
                        .first_id = first,
                        .look = object.material.value_or(none)});
    first += static_cast<PrimitiveId>(primitive_count(object.shape));
    const Material& material = material_of(scene, object);
    all_cover_ &= material.double_sided && material.alpha_mode == AlphaMode::opaque;
  }
}

Shading::~Shading() = default;

ShadingPoint Shading::point(const Ray& ray, const Hit& hit, float begin, float spread) const {
  const Entry& entry = entries_[primitives_.object_index(hit.id)];
  ShadingPoint result{
      .at = surface_point(primitives_, ray, hit, entry.mesh, hit.id - entry.first_id),
      .look = &looks_[entry.look]};
  result.width = begin + spread * result.at.distance;
  return result;
}

ShadingPoint Shading::point_on(PrimitiveId id, const Vec3& barycentrics, bool front,
                               float width) const {
  const Entry& entry = entries_[primitives_.object_index(id)];
  return {.at = surface_point(*entry.mesh, id - entry.first_id, barycentrics, front),
          .look = &looks_[entry.look],
          .width = width};
}

void Shading::find_place(ShadingPoint& point) {
  const TexturedMaterial& look = *point.look;
  if (look.layout != nullptr) point.place = place_of(*look.layout, *look.layout_use, point);
}

Vec4 Shading::base_color(const ShadingPoint& point) const {
  const TexturedMaterial& look = *point.look;
  Vec4 color = look.material->base_color * point.at.color();
  if (look.base_color != nullptr)
    color *= look_up(*look.base_color, *look.material->base_color_texture, point);
  return color;
}

float Shading::coverage(const ShadingPoint& point) const {
  const Material& material = *point.look->material;
  if (!point.at.front && !material.double_sided) return 0;
  if (material.alpha_mode == AlphaMode::opaque) return 1;
  const float alpha = base_color(point).w;
  if (material.alpha_mode == AlphaMode::mask) return alpha >= material.alpha_cutoff ? 1 : 0;
  return std::clamp(alpha, 0.0F, 1.0F);
}

Vec3 Shading::emission(const ShadingPoint& point) const {
  const TexturedMaterial& look = *point.look;
  if (look.material->unlit) return Vec3(base_color(point));
  Vec3 color = look.material->emissive;
  if (color != Vec3(0) && look.emissive != nullptr)
    color *= Vec3(look_up(*look.emissive, *look.material->emissive_texture, point));
  return color;
}

bsdf::Parameters Shading::parameters(const ShadingPoint& point) const {
  const TexturedMaterial& look = *point.look;
  bsdf::Parameters p{.base_color = glm::clamp(Vec3(base_color(point)), Vec3(0), Vec3(1)),
                     .metallic = look.material->metallic,
                     .roughness = look.material->roughness};
  if (look.metallic_roughness != nullptr) {
    const Vec4 t =
        look_up(*look.metallic_roughness, *look.material->metallic_roughness_texture, point);
    p.roughness *= t.y;
    p.metallic *= t.z;
  }
  return p;
}

bsdf::Frame Shading::frame(const ShadingPoint& point, const Vec3& wo) const {
  const TexturedMaterial& look = *point.look;
  Vec3 n = point.at.ns;
  if (look.normal != nullptr) {
    const Vec4 tangent = point.at.tangent();
    if (tangent.w != 0) {
      const Vec3 t(tangent), b = tangent.w * glm::cross(n, t);
      const Vec3 v =
          Vec3(look_up(*look.normal, *look.material->normal_texture, point)) * 2.0F - Vec3(1);
      const float scale = look.material->normal_scale;
      const Vec3 turned = scale * v.x * t + scale * v.y * b + v.z * n;
      if (glm::dot(turned, turned) > 0) n = bsdf::unit(turned);
    }
  }
  if (!point.at.front) n = -n;
  return bsdf::Frame::about(turned_towards(n, wo));
}

}  // namespace microtrace
