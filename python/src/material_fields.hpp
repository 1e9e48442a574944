#pragma once
/// The part of fields.hpp for materials.

#include "field.hpp"

#include <microtrace/material.hpp>

#include <tuple>

namespace microtrace::python {

template <>
struct Class<Specular> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Specular";
  static constexpr auto kFields =
      std::tuple(Field{"specular_factor", &Specular::factor, "factor"},
                 Field{"specular_texture", &Specular::texture, "texture"},
                 Field{"specular_color_factor", &Specular::color, "color"},
                 Field{"specular_color_texture", &Specular::color_texture, "color_texture"});
};

template <>
struct Class<Transmission> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Transmission";
  static constexpr auto kFields =
      std::tuple(Field{"transmission_factor", &Transmission::factor, "factor"},
                 Field{"transmission_texture", &Transmission::texture, "texture"});
};

template <>
struct Class<Volume> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Volume";
  static constexpr auto kFields =
      std::tuple(Field{"thickness_factor", &Volume::thickness, "thickness"},
                 Field{"thickness_texture", &Volume::texture, "texture"},
                 Field{"attenuation_distance", &Volume::attenuation_distance},
                 Field{"attenuation_color", &Volume::attenuation_color});
};

template <>
struct Class<VolumeScatter> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "VolumeScatter";
  static constexpr auto kFields =
      std::tuple(Field{"multiscatter_color", &VolumeScatter::multiscatter_color},
                 Field{"scatter_anisotropy", &VolumeScatter::anisotropy, "anisotropy"});
};

template <>
struct Class<Clearcoat> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Clearcoat";
  static constexpr auto kFields = std::tuple(
      Field{"clearcoat_factor", &Clearcoat::factor, "factor"},
      Field{"clearcoat_roughness_factor", &Clearcoat::roughness, "roughness"},
      Field{"clearcoat_texture", &Clearcoat::texture, "texture"},
      Field{"clearcoat_roughness_texture", &Clearcoat::roughness_texture, "roughness_texture"},
      Field{"clearcoat_normal_texture", &Clearcoat::normal_texture, "normal_texture"},
      Field{"clearcoat_normal_scale", &Clearcoat::normal_scale, "normal_scale"});
};

template <>
struct Class<Sheen> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Sheen";
  static constexpr auto kFields =
      std::tuple(Field{"sheen_color_factor", &Sheen::color, "color"},
                 Field{"sheen_roughness_factor", &Sheen::roughness, "roughness"},
                 Field{"sheen_color_texture", &Sheen::color_texture, "color_texture"},
                 Field{"sheen_roughness_texture", &Sheen::roughness_texture, "roughness_texture"});
};

template <>
struct Class<Anisotropy> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Anisotropy";
  static constexpr auto kFields =
      std::tuple(Field{"anisotropy_strength", &Anisotropy::strength, "strength"},
                 Field{"anisotropy_rotation", &Anisotropy::rotation, "rotation"},
                 Field{"anisotropy_texture", &Anisotropy::texture, "texture"});
};

template <>
struct Class<Iridescence> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Iridescence";
  static constexpr auto kFields = std::tuple(
      Field{"iridescence_factor", &Iridescence::factor, "factor"},
      Field{"iridescence_ior", &Iridescence::ior, "ior"},
      Field{"iridescence_thickness_minimum", &Iridescence::thickness_minimum, "thickness_minimum"},
      Field{"iridescence_thickness_maximum", &Iridescence::thickness_maximum, "thickness_maximum"},
      Field{"iridescence_texture", &Iridescence::texture, "texture"},
      Field{"iridescence_thickness_texture", &Iridescence::thickness_texture, "thickness_texture"});
};

template <>
struct Class<DiffuseTransmission> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "DiffuseTransmission";
  static constexpr auto kFields =
      std::tuple(Field{"diffuse_transmission_factor", &DiffuseTransmission::factor, "factor"},
                 Field{"diffuse_transmission_texture", &DiffuseTransmission::texture, "texture"},
                 Field{"diffuse_transmission_color_factor", &DiffuseTransmission::color, "color"},
                 Field{"diffuse_transmission_color_texture", &DiffuseTransmission::color_texture,
                       "color_texture"});
};

template <>
struct Class<SpecularGlossiness> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "SpecularGlossiness";
  static constexpr auto kFields =
      std::tuple(Field{"specular_factor", &SpecularGlossiness::specular, "specular"},
                 Field{"glossiness_factor", &SpecularGlossiness::glossiness, "glossiness"},
                 Field{"specular_glossiness_texture", &SpecularGlossiness::texture, "texture"});
};

template <>
struct Class<Material> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Material";
  static constexpr auto kFields = std::tuple(
      Field{"name", &Material::name},
      Field{"base_color_factor", &Material::base_color, "base_color"},
      Field{"base_color_texture", &Material::base_color_texture},
      Field{"alpha_mode", &Material::alpha_mode}, Field{"alpha_cutoff", &Material::alpha_cutoff},
      Field{"double_sided", &Material::double_sided}, Field{"unlit", &Material::unlit},
      Field{"metallic_factor", &Material::metallic, "metallic"},
      Field{"roughness_factor", &Material::roughness, "roughness"},
      Field{"metallic_roughness_texture", &Material::metallic_roughness_texture},
      Field{"normal_texture", &Material::normal_texture},
      Field{"normal_scale", &Material::normal_scale},
      Field{"occlusion_texture", &Material::occlusion_texture},
      Field{"occlusion_strength", &Material::occlusion_strength},
      Field{"emissive_factor", &Material::emissive, "emissive"},
      Field{"emissive_texture", &Material::emissive_texture}, Field{"ior", &Material::ior},
      Field{"dispersion", &Material::dispersion}, Field{"specular", &Material::specular},
      Field{"transmission", &Material::transmission}, Field{"volume", &Material::volume},
      Field{"volume_scatter", &Material::volume_scatter}, Field{"clearcoat", &Material::clearcoat},
      Field{"sheen", &Material::sheen}, Field{"anisotropy", &Material::anisotropy},
      Field{"iridescence", &Material::iridescence},
      Field{"diffuse_transmission", &Material::diffuse_transmission},
      Field{"specular_glossiness", &Material::specular_glossiness});
};

}  // namespace microtrace::python
