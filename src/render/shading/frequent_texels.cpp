/// Looks up the textures of many points at a time, so that their memory accesses overlap.

#include "render/shading/hit_group.hpp"
#include "render/shading/shading.hpp"

#include <bit>

namespace microtrace {

void TexturedMaterial::fetch(const TextureMap::TexelAddress& address) const {
  for (const MaterialTexture texture : kFrequent) {
    const TextureSlot& slot = (*this)[texture];
    if (slot.shares_address) slot.map->fetch(address);
  }
}

void Shading::look_up(const HitGroup& group, Lanes lanes, const LaneFloats& widths,
                      FrequentTexels& texels) {
  std::array<TextureMap::TexelAddress, kShadingLanes> addresses;
  for (Lanes rest = lanes; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    const auto i = static_cast<std::size_t>(lane);
    if (!group.looks[i]->is_textured) continue;
    const auto& uv = group.lanes.first_uv;
    addresses[i] = group.looks[i]->layout.texel_address({uv[0][lane], uv[1][lane]},
                                                        widths[lane] * group.lanes.uv_scale[lane]);
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
}

}  // namespace microtrace
