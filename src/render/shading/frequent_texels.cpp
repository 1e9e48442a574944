/// Looks up the textures of many points at a time, so that their memory accesses overlap.

#include "render/shading/hit_group.hpp"
#include "render/shading/shading.hpp"

#include <bit>

namespace microtrace {
namespace {

TextureMap::TexelAddress layout_address(const HitGroup& group, int lane, float width) {
  const auto& uv = group.lanes.first_uv;
  return group.looks[static_cast<std::size_t>(lane)]->layout.texel_address(
      {uv[0][lane], uv[1][lane]}, width * group.lanes.uv_scale[lane]);
}

/// Looks up the emission and the alpha of a lane without a filter.
void look_up_unfiltered(const HitGroup& group, int lane, FrequentTexels& texels) {
  const auto i = static_cast<std::size_t>(lane);
  const TexturedMaterial& look = *group.looks[i];
  const TextureMap* base_color = look[MaterialTexture::base_color].map;
  const TextureMap* emissive = look[MaterialTexture::emissive].map;
  const bool has_alpha = base_color != nullptr && look.material->alpha_mode != AlphaMode::opaque;
  const bool is_emissive = emissive != nullptr && look.is_emissive();
  if (!has_alpha && !is_emissive) return;
  const TextureMap::TexelAddress address = layout_address(group, lane, 0);
  if (has_alpha) texels.base_color[i].w = base_color->sample(address).w;
  if (is_emissive) texels.emissive[i] = emissive->sample(address);
}

}  // namespace

void TexturedMaterial::fetch(const TextureMap::TexelAddress& address) const {
  for (const MaterialTexture texture : kFrequent) {
    const TextureSlot& slot = (*this)[texture];
    if (slot.shares_address) slot.map->fetch(address);
  }
}

void Shading::look_up(const HitGroup& group, Lanes lanes, const LaneFloats& widths,
                      bool from_camera, FrequentTexels& texels) {
  std::array<TextureMap::TexelAddress, kShadingLanes> addresses;
  for (Lanes rest = lanes; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    const auto i = static_cast<std::size_t>(lane);
    if (!group.looks[i]->is_textured) continue;
    addresses[i] = layout_address(group, lane, widths[lane]);
    group.looks[i]->fetch(addresses[i]);
  }
  const auto look_up = [&](MaterialTexture texture, std::array<Vec4, kShadingLanes>& values) {
    for (Lanes rest = lanes; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      const TextureMap* map = (*group.looks[i])[texture].map;
      values[i] = map == nullptr ? Vec4(1) : map->sample(addresses[i]);
    }
  };
  look_up(MaterialTexture::base_color, texels.base_color);
  look_up(MaterialTexture::metallic_roughness, texels.metallic_roughness);
  look_up(MaterialTexture::normal, texels.normal);
  look_up(MaterialTexture::emissive, texels.emissive);
  for (Lanes rest = from_camera ? 0 : lanes; rest != 0; rest &= rest - 1)
    look_up_unfiltered(group, std::countr_zero(rest), texels);
}

}  // namespace microtrace
