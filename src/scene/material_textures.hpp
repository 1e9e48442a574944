#pragma once
/// All textures of a material.

#include <microtrace/material.hpp>
#include <microtrace/texture.hpp>

namespace microtrace {

/// Calls visit(TextureUse&, ColorEncoding) for each texture of the material. The reference is const
/// if the material is.
template <typename AnyMaterial, typename Visit>
void for_each_texture(AnyMaterial& material, const Visit& visit) {
  const auto srgb = [&](auto& use) {
    if (use) visit(*use, ColorEncoding::srgb);
  };
  const auto linear = [&](auto& use) {
    if (use) visit(*use, ColorEncoding::linear);
  };
  srgb(material.base_color_texture);
  linear(material.metallic_roughness_texture);
  linear(material.normal_texture);
  linear(material.occlusion_texture);
  srgb(material.emissive_texture);
  if (auto& specular = material.specular) {
    linear(specular->texture);
    srgb(specular->color_texture);
  }
  if (auto& transmission = material.transmission) linear(transmission->texture);
  if (auto& volume = material.volume) linear(volume->texture);
  if (auto& clearcoat = material.clearcoat) {
    linear(clearcoat->texture);
    linear(clearcoat->roughness_texture);
    linear(clearcoat->normal_texture);
  }
  if (auto& sheen = material.sheen) {
    srgb(sheen->color_texture);
    linear(sheen->roughness_texture);
  }
  if (auto& anisotropy = material.anisotropy) linear(anisotropy->texture);
  if (auto& iridescence = material.iridescence) {
    linear(iridescence->texture);
    linear(iridescence->thickness_texture);
  }
  if (auto& diffuse = material.diffuse_transmission) {
    linear(diffuse->texture);
    srgb(diffuse->color_texture);
  }
  if (auto& archived = material.specular_glossiness) srgb(archived->texture);
}

}  // namespace microtrace
