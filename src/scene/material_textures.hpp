#pragma once
/// All textures of a material.

#include <microtrace/material.hpp>
#include <microtrace/texture.hpp>

#include <cstddef>

namespace microtrace {

/// The textures that a material may have.
enum class MaterialTexture {
  base_color,
  metallic_roughness,
  normal,
  occlusion,
  emissive,
  specular,
  specular_color,
  transmission,
  thickness,
  clearcoat,
  clearcoat_roughness,
  clearcoat_normal,
  sheen_color,
  sheen_roughness,
  anisotropy,
  iridescence,
  iridescence_thickness,
  diffuse_transmission,
  diffuse_transmission_color,
  specular_glossiness,
  count,  ///< number of textures
};

/// True if path tracing reads the texture. It computes occlusion itself, so it ignores occlusion
/// textures. It only distinguishes a thickness of 0 from others, so it ignores thickness textures.
/// Unlit surfaces use only their base color and emission.
[[nodiscard]] inline bool affects_light(const Material& material, MaterialTexture texture) {
  using enum MaterialTexture;
  if (material.unlit) return texture == base_color || texture == emissive;
  return texture != occlusion && texture != thickness;
}

/// True if the surface may emit light, unless its texture is black. Unlit surfaces light nothing.
[[nodiscard]] inline bool is_emissive(const Material& material) {
  return material.emissive != Vec3(0) && !material.unlit;
}

/// Calls visit(MaterialTexture, TextureUse&, ColorEncoding) for each texture that the material has.
/// The reference is const if the material is.
template <typename AnyMaterial, typename Visit>
void for_each_named_texture(AnyMaterial& material, const Visit& visit) {
  using enum MaterialTexture;
  const auto srgb = [&](MaterialTexture name, auto& use) {
    if (use) visit(name, *use, ColorEncoding::srgb);
  };
  const auto linear = [&](MaterialTexture name, auto& use) {
    if (use) visit(name, *use, ColorEncoding::linear);
  };
  srgb(base_color, material.base_color_texture);
  linear(metallic_roughness, material.metallic_roughness_texture);
  linear(normal, material.normal_texture);
  linear(occlusion, material.occlusion_texture);
  srgb(emissive, material.emissive_texture);
  if (auto& layer = material.specular) {
    linear(specular, layer->texture);
    srgb(specular_color, layer->color_texture);
  }
  if (auto& layer = material.transmission) linear(transmission, layer->texture);
  if (auto& layer = material.volume) linear(thickness, layer->texture);
  if (auto& layer = material.clearcoat) {
    linear(clearcoat, layer->texture);
    linear(clearcoat_roughness, layer->roughness_texture);
    linear(clearcoat_normal, layer->normal_texture);
  }
  if (auto& layer = material.sheen) {
    srgb(sheen_color, layer->color_texture);
    linear(sheen_roughness, layer->roughness_texture);
  }
  if (auto& layer = material.anisotropy) linear(anisotropy, layer->texture);
  if (auto& layer = material.iridescence) {
    linear(iridescence, layer->texture);
    linear(iridescence_thickness, layer->thickness_texture);
  }
  if (auto& layer = material.diffuse_transmission) {
    linear(diffuse_transmission, layer->texture);
    srgb(diffuse_transmission_color, layer->color_texture);
  }
  if (auto& layer = material.specular_glossiness) srgb(specular_glossiness, layer->texture);
}

/// Like for_each_named_texture, but calls visit(TextureUse&, ColorEncoding), without the name.
template <typename AnyMaterial, typename Visit>
void for_each_texture(AnyMaterial& material, const Visit& visit) {
  for_each_named_texture(
      material, [&](MaterialTexture, auto& use, ColorEncoding encoding) { visit(use, encoding); });
}

}  // namespace microtrace
