#include "render/shading/texture_slots.hpp"

#include "render/shading/points/hit_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace microtrace {

TexelAddress<1> TextureSlot::texel_address(const ShadingPoint& point) const {
  const float width = point.width > 0 ? point.width * point.at.uv_scale(use->uv_set) : 0;
  return texel_address(point.at.uv(use->uv_set), width);
}

TexelAddress<1> TextureSlot::texel_address(const Vec2& uv, float width) const {
  const auto& m = use->texture_from_uv;
  return map->texel_address(m[0] * uv.x + m[1] * uv.y + m[2], width * width_scale);
}

Vec4 TextureSlot::look_up(const ShadingPoint& point) const {
  return map->sample(shares_address && point.texel_address ? *point.texel_address
                                                           : texel_address(point));
}

bool TextureSlot::is_magnified(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners,
                               double part) const {
  if (map == nullptr) return true;
  double area = 0;
  if (has_uv(mesh, use->uv_set)) {
    const auto uv = [&](std::size_t i) { return DVec2(mesh.uv_sets[use->uv_set][corners[i]]); };
    const DVec2 e1 = uv(1) - uv(0), e2 = uv(2) - uv(0);
    area = std::abs(e1.x * e2.y - e1.y * e2.x);
  }
  const double scale = double{width_scale} * std::max(map->image().width, map->image().height);
  return part * area * scale * scale < 0.99;
}

TextureSlot TextureMaps::slot(const TextureUse& use, ColorEncoding encoding) {
  const Texture& texture = scene_.textures[use.texture];
  if (!texture.image || !scene_.images[*texture.image]) return {};
  const std::pair key(use.texture, encoding);
  auto known = maps_.find(key);
  if (known == maps_.end()) {
    TextureMap map = textures_.map(scene_.images[*texture.image], texture.sampler, encoding);
    known = maps_.emplace(key, std::move(map)).first;
  }
  const auto& m = use.texture_from_uv;
  return {.map = &known->second,
          .use = &use,
          .width_scale = std::sqrt(std::abs(m[0].x * m[1].y - m[0].y * m[1].x))};
}

TexturedMaterial TextureMaps::slots(const Material& m) {
  TexturedMaterial look{.material = &m};
  for_each_named_texture(
      m, [&](MaterialTexture texture, const TextureUse& use, ColorEncoding encoding) {
        if (affects_light(m, texture)) look[texture] = slot(use, encoding);
      });
  if (encloses_medium(m)) look.medium = medium_of(m);
  for (const MaterialTexture texture : TexturedMaterial::kFrequent) {
    TextureSlot& slot = look[texture];
    if (slot.map == nullptr) continue;
    if (look.layout.map == nullptr) look.layout = slot;
    slot.shares_address = slot.map->is_laid_out_as(*look.layout.map) &&
                          slot.use->uv_set == look.layout.use->uv_set &&
                          slot.use->texture_from_uv == look.layout.use->texture_from_uv;
  }
  return look;
}

namespace {

/// Adds a lookup to a surface.
void add_read(TexturedSurface& surface, const TextureSlot& slot, TexelValue value,
              bool is_filtered) {
  if (slot.map == nullptr) return;
  const auto& m = slot.use->texture_from_uv;
  const TexelLayout layout{.grid = slot.map->grid(),
                           .grid_from_uv = {{m[0].x, m[0].y}, {m[1].x, m[1].y}, {m[2].x, m[2].y}},
                           .width_scale = is_filtered ? slot.width_scale : 0};
  TexelLayout* const end = surface.layouts + surface.layout_count;
  TexelLayout* const place = std::find(surface.layouts, end, layout);
  if (place == end) {
    *place = layout;
    ++surface.layout_count;
  }
  surface.reads[surface.read_count++] = {.texels = slot.map->texels(),
                                         .layout = static_cast<int>(place - surface.layouts),
                                         .value = static_cast<int>(value)};
}

TexturedSurface kernel_surface(const TexturedMaterial& look, bool from_camera) {
  const Material& m = *look.material;
  TexturedSurface surface{.metallic = m.metallic,
                          .roughness = m.roughness,
                          .normal_scale = m.normal_scale,
                          .covering_alpha = Shading::covering_alpha(m)};
  for (glm::length_t i = 0; i < 4; ++i) surface.base_color[i] = m.base_color[i];
  for (glm::length_t i = 0; i < 3; ++i) surface.emission[i] = m.emissive[i];
  const auto add = [&](MaterialTexture texture, TexelValue value, bool is_filtered) {
    add_read(surface, look[texture], value, is_filtered);
  };
  add(MaterialTexture::base_color, TexelValue::base_color, true);
  add(MaterialTexture::metallic_roughness, TexelValue::metallic_roughness, true);
  add(MaterialTexture::normal, TexelValue::normal, true);
  if (look.is_emissive()) add(MaterialTexture::emissive, TexelValue::emission, from_camera);
  if (m.alpha_mode != AlphaMode::opaque)
    add(MaterialTexture::base_color, TexelValue::alpha, from_camera);
  return surface;
}

}  // namespace

void set_kernel_surfaces(TexturedMaterial& look) {
  if (!look.constant_but_textures || look.kernel_surfaces) return;
  look.kernel_surfaces =
      std::make_shared<const TexturedMaterial::KernelSurfaces>(TexturedMaterial::KernelSurfaces{
          .from_camera = kernel_surface(look, true), .from_others = kernel_surface(look, false)});
}

}  // namespace microtrace
