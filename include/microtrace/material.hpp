#pragma once
/// What a surface is made of: the metallic-roughness model of glTF 2.0, section 3.9, and the
/// extensions KHR_materials_*, each a struct by the extension's name. One that has no effect,
/// whatever its textures say, is left out.

#include <microtrace/math.hpp>
#include <microtrace/texture.hpp>

#include <limits>
#include <optional>
#include <string>

namespace microtrace {

/// What the alpha of a base colour means (glTF 2.0, section 3.9.4).
enum class AlphaMode {
  opaque,  ///< nothing
  mask,    ///< the surface is there where alpha is at least the cutoff
  blend,   ///< the share of the surface's colour; what lies behind shows through
};

/// How much a dielectric reflects (KHR_materials_specular).
struct Specular {
  float factor = 1;                           ///< of the reflection, in [0, 1]
  std::optional<TextureUse> texture{};        ///< linear; alpha: factor
  Vec3 color{1};                              ///< of the reflection head on, not negative
  std::optional<TextureUse> color_texture{};  ///< sRGB
};

/// Light that goes through the surface of a dielectric (KHR_materials_transmission).
struct Transmission {
  float factor = 0;                     ///< share of what is not reflected, in [0, 1]
  std::optional<TextureUse> texture{};  ///< linear; r
};

/// The surface encloses a medium (KHR_materials_volume); without, it is a thin wall that bends no
/// light. Light is absorbed along its real way, so that only whether there is thickness matters.
struct Volume {
  float thickness = 0;                  ///< mesh's own space, not negative; 0: a thin wall
  std::optional<TextureUse> texture{};  ///< linear; g: thickness
  /// World space, positive; after it white light has the colour below.
  float attenuation_distance = std::numeric_limits<float>::infinity();
  Vec3 attenuation_color{1};  ///< linear Rec. 709, each in [0, 1]
};

/// A smooth or rough coat of index 1.5 over all else (KHR_materials_clearcoat).
struct Clearcoat {
  float factor = 0, roughness = 0;                ///< each in [0, 1]
  std::optional<TextureUse> texture{};            ///< linear; r: factor
  std::optional<TextureUse> roughness_texture{};  ///< linear; g: roughness
  std::optional<TextureUse> normal_texture{};     ///< linear; tangent space; nothing: no bumps
  float normal_scale = 1;                         ///< of the texture's x and y
};

/// Fibres over all but the coat (KHR_materials_sheen).
struct Sheen {
  Vec3 color{0};                                  ///< linear Rec. 709, each in [0, 1]
  float roughness = 0;                            ///< in [0, 1]
  std::optional<TextureUse> color_texture{};      ///< sRGB
  std::optional<TextureUse> roughness_texture{};  ///< linear; alpha: roughness
};

/// Highlights longer one way than the other (KHR_materials_anisotropy).
struct Anisotropy {
  float strength = 0;  ///< in [0, 1]
  float rotation =
      0;  ///< of the long way, anticlockwise from the tangent, radians, in (-2 pi, 2 pi)
  std::optional<TextureUse> texture{};  ///< linear; rg: the long way from [-1, 1], b: strength
};

/// A thin film over the surface (KHR_materials_iridescence).
struct Iridescence {
  float factor = 0;                                        ///< in [0, 1]
  float ior = 1.3F;                                        ///< of the film, at least 1
  float thickness_minimum = 100, thickness_maximum = 400;  ///< nanometres, not negative
  std::optional<TextureUse> texture{};                     ///< linear; r: factor
  /// Linear; g: 0 means the minimum, 1 the maximum. Without, the film has the maximum.
  std::optional<TextureUse> thickness_texture{};
};

/// Diffuse light that goes through the surface (KHR_materials_diffuse_transmission).
struct DiffuseTransmission {
  float factor = 0;                           ///< share of the diffuse light, in [0, 1]
  std::optional<TextureUse> texture{};        ///< linear; alpha: factor
  Vec3 color{1};                              ///< linear Rec. 709, each in [0, 1]
  std::optional<TextureUse> color_texture{};  ///< sRGB
};

/// Stands for metallic and roughness; the base colour is then the diffuse one
/// (KHR_materials_pbrSpecularGlossiness, archived).
struct SpecularGlossiness {
  Vec3 specular{1};                     ///< reflection head on, linear Rec. 709, each in [0, 1]
  float glossiness = 1;                 ///< 1 - roughness, in [0, 1]
  std::optional<TextureUse> texture{};  ///< rgb, sRGB: specular; alpha, linear: glossiness
};

/// The defaults make a white surface, seen from both sides. Factors multiply what textures say.
/// A flat picture shows the base colour; all below `unlit` is for pictures with light.
struct Material {
  std::string name{};
  Vec4 base_color{1};                              ///< linear Rec. 709 and alpha, each in [0, 1]
  std::optional<TextureUse> base_color_texture{};  ///< sRGB, alpha linear
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5F;
  bool double_sided = true;  ///< if not, nothing is seen from the back
  bool unlit = false;        ///< light does not change its colour (KHR_materials_unlit)

  float metallic = 0, roughness = 1;                       ///< each in [0, 1]
  std::optional<TextureUse> metallic_roughness_texture{};  ///< linear; g: roughness, b: metallic
  std::optional<TextureUse> normal_texture{};              ///< linear; tangent space
  float normal_scale = 1;                                  ///< of the texture's x and y
  std::optional<TextureUse> occlusion_texture{};           ///< linear; r
  float occlusion_strength = 1;                            ///< in [0, 1]
  /// Linear Rec. 709, not negative; KHR_materials_emissive_strength is multiplied in.
  Vec3 emissive{0};
  std::optional<TextureUse> emissive_texture{};  ///< sRGB

  /// Index of refraction, at least 1, or 0: infinite, so that all is reflected (KHR_materials_ior).
  float ior = 1.5F;
  float dispersion = 0;  ///< 20 / Abbe number, not negative (KHR_materials_dispersion)
  std::optional<Specular> specular{};
  std::optional<Transmission> transmission{};
  std::optional<Volume> volume{};
  std::optional<Clearcoat> clearcoat{};
  std::optional<Sheen> sheen{};
  std::optional<Anisotropy> anisotropy{};
  std::optional<Iridescence> iridescence{};
  std::optional<DiffuseTransmission> diffuse_transmission{};
  std::optional<SpecularGlossiness> specular_glossiness{};
};

}  // namespace microtrace
