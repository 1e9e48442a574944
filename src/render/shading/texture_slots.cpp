#include "render/shading/texture_slots.hpp"

#include <cmath>

namespace microtrace {

TextureMap::TexelAddress TextureSlot::texel_address(const ShadingPoint& point) const {
  return texel_address(point.at.uv(use->uv_set), point.width * point.at.uv_scale);
}

TextureMap::TexelAddress TextureSlot::texel_address(const Vec2& uv, float width) const {
  const auto& m = use->texture_from_uv;
  return map->texel_address(m[0] * uv.x + m[1] * uv.y + m[2], width * width_scale);
}

Vec4 TextureSlot::look_up(const ShadingPoint& point) const {
  return map->sample(shares_address && point.texel_address ? *point.texel_address
                                                           : texel_address(point));
}

TextureSlot TextureMaps::slot(const TextureUse& use, ColorEncoding encoding) {
  const Texture& texture = scene_.textures[use.texture];
  if (!texture.image || !scene_.images[*texture.image]) return {};
  const std::pair key(use.texture, encoding);
  auto known = maps_.find(key);
  if (known == maps_.end()) {
    TextureMap map = tables_.texture_map(scene_.images[*texture.image], texture.sampler, encoding);
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

}  // namespace microtrace
