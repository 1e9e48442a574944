#pragma once
/// Surface materials: the metallic-roughness model of glTF 2.0, section 3.9, and the extensions
/// KHR_materials_*, each in a struct with the extension's name. Loaders omit extensions whose
/// factors leave them without effect.
///
/// Comments on textures name the encoding of their colors (sRGB or linear) and the channels that
/// are used; "alpha: factor" means that alpha is multiplied with the factor.

#include <microtrace/math.hpp>
#include <microtrace/texture.hpp>

#include <limits>
#include <optional>
#include <string>

namespace microtrace {

/// How the base color's alpha is used (glTF 2.0, section 3.9.4).
enum class AlphaMode {
  opaque,  ///< alpha is ignored
  mask,    ///< the surface exists only where alpha is at least the cutoff
  blend,   ///< alpha is the opacity; surfaces behind show through
};

/// The reflectance of a dielectric (KHR_materials_specular).
struct Specular {
  float factor = 1;                     ///< strength of the reflection, in [0, 1]
  std::optional<TextureUse> texture{};  ///< linear; alpha: factor
  Vec3 color{1};                        ///< color of the reflection at normal incidence, linear
                                        ///< Rec. 709, not negative
  std::optional<TextureUse> color_texture{};  ///< sRGB

  bool operator==(const Specular&) const = default;
};

/// Transmission through the surface of a dielectric (KHR_materials_transmission).
struct Transmission {
  float factor = 0;  ///< transmitted fraction of the light that is not reflected, in [0, 1]
  std::optional<TextureUse> texture{};  ///< linear; r

  bool operator==(const Transmission&) const = default;
};

/// The medium that the surface encloses (KHR_materials_volume), if light can enter it: by
/// transmission, which is then refracted, or by diffuse transmission. A surface without a volume is
/// a thin wall, which does not refract. Absorption depends on the actual length of the path in the
/// medium; the thickness only distinguishes thin walls (0) from volumes.
struct Volume {
  float thickness = 0;                  ///< in the mesh's local space, not negative; 0: a thin wall
  std::optional<TextureUse> texture{};  ///< linear; g: thickness
  /// The distance after which white light has the attenuation color, in world space; positive.
  float attenuation_distance = std::numeric_limits<float>::infinity();
  Vec3 attenuation_color{1};  ///< linear Rec. 709, each in [0, 1]

  bool operator==(const Volume&) const = default;
};

/// Scattering in the medium that the surface encloses (KHR_materials_volume_scatter, a draft of
/// 2025). The attenuation of `Volume` then counts both absorbed and scattered light. It has no
/// effect without a finite attenuation_distance.
struct VolumeScatter {
  /// The approximate color of a thick body by scattering, linear Rec. 709, each in [0, 1].
  Vec3 multiscatter_color{0};
  /// The mean cosine of scattering angles, in [-1, 1]: light is scattered mostly forward if
  /// positive, mostly back if negative.
  float anisotropy = 0;

  bool operator==(const VolumeScatter&) const = default;
};

/// A coat with index of refraction 1.5 over all other layers (KHR_materials_clearcoat).
struct Clearcoat {
  float factor = 0, roughness = 0;                ///< each in [0, 1]
  std::optional<TextureUse> texture{};            ///< linear; r: factor
  std::optional<TextureUse> roughness_texture{};  ///< linear; g: roughness
  std::optional<TextureUse> normal_texture{};     ///< linear; tangent space; nothing: unperturbed
  float normal_scale = 1;                         ///< of the texture's x and y

  bool operator==(const Clearcoat&) const = default;
};

/// Fibers over all layers except the coat (KHR_materials_sheen).
struct Sheen {
  Vec3 color{0};                                  ///< linear Rec. 709, each in [0, 1]
  float roughness = 0;                            ///< in [0, 1]
  std::optional<TextureUse> color_texture{};      ///< sRGB
  std::optional<TextureUse> roughness_texture{};  ///< linear; alpha: roughness

  bool operator==(const Sheen&) const = default;
};

/// Elongated highlights (KHR_materials_anisotropy).
struct Anisotropy {
  float strength = 0;  ///< in [0, 1]
  float rotation = 0;  ///< rotation of the direction of highlights, counterclockwise from the
                       ///< tangent, radians, in (-2 pi, 2 pi)
  std::optional<TextureUse> texture{};  ///< linear; rg: direction in [-1, 1], b: strength

  bool operator==(const Anisotropy&) const = default;
};

/// A thin film over the surface (KHR_materials_iridescence).
struct Iridescence {
  float factor = 0;                                        ///< in [0, 1]
  float ior = 1.3F;                                        ///< the film's index of refraction, at
                                                           ///< least 1
  float thickness_minimum = 100, thickness_maximum = 400;  ///< nanometers, not negative
  std::optional<TextureUse> texture{};                     ///< linear; r: factor
  /// Linear; g: 0 means the minimum thickness, 1 the maximum. Without a texture the film has the
  /// maximum thickness.
  std::optional<TextureUse> thickness_texture{};

  bool operator==(const Iridescence&) const = default;
};

/// Diffuse transmission through the surface (KHR_materials_diffuse_transmission).
struct DiffuseTransmission {
  float factor = 0;                     ///< transmitted fraction of the diffuse light, in [0, 1]
  std::optional<TextureUse> texture{};  ///< linear; alpha: factor
  Vec3 color{1};                        ///< linear Rec. 709, each in [0, 1]
  std::optional<TextureUse> color_texture{};  ///< sRGB

  bool operator==(const DiffuseTransmission&) const = default;
};

/// Replaces metallic and roughness. The base color becomes the diffuse color
/// (KHR_materials_pbrSpecularGlossiness, archived).
struct SpecularGlossiness {
  Vec3 specular{1};      ///< reflectance at normal incidence, linear Rec. 709, each in [0, 1]
  float glossiness = 1;  ///< 1 - roughness, in [0, 1]
  std::optional<TextureUse> texture{};  ///< rgb, sRGB: specular; alpha, linear: glossiness

  bool operator==(const SpecularGlossiness&) const = default;
};

/// The material of a surface; by default white, rough and two-sided. Factors are multiplied with
/// textures. Flat pictures show the base color; members after `unlit` only affect path-traced
/// pictures.
struct Material {
  std::string name{};
  Vec4 base_color{1};                              ///< linear Rec. 709 and alpha, each in [0, 1]
  std::optional<TextureUse> base_color_texture{};  ///< sRGB, alpha linear
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5F;
  bool double_sided = true;  ///< if false, back faces are culled
  bool unlit = false;        ///< the base color is shown without lighting (KHR_materials_unlit)

  float metallic = 0, roughness = 1;                       ///< each in [0, 1]
  std::optional<TextureUse> metallic_roughness_texture{};  ///< linear; g: roughness, b: metallic
  std::optional<TextureUse> normal_texture{};              ///< linear; tangent space
  float normal_scale = 1;                                  ///< of the texture's x and y
  std::optional<TextureUse> occlusion_texture{};           ///< linear; r
  float occlusion_strength = 1;                            ///< in [0, 1]
  /// Linear Rec. 709, not negative; includes the factor of KHR_materials_emissive_strength.
  Vec3 emissive{0};
  std::optional<TextureUse> emissive_texture{};  ///< sRGB

  /// Index of refraction, at least 1, or 0 for infinity, where all light is reflected
  /// (KHR_materials_ior).
  float ior = 1.5F;
  float dispersion = 0;  ///< 20 / Abbe number, not negative (KHR_materials_dispersion)
  std::optional<Specular> specular{};
  std::optional<Transmission> transmission{};
  std::optional<Volume> volume{};
  std::optional<VolumeScatter> volume_scatter{};
  std::optional<Clearcoat> clearcoat{};
  std::optional<Sheen> sheen{};
  std::optional<Anisotropy> anisotropy{};
  std::optional<Iridescence> iridescence{};
  std::optional<DiffuseTransmission> diffuse_transmission{};
  std::optional<SpecularGlossiness> specular_glossiness{};

  bool operator==(const Material&) const = default;
};

}  // namespace microtrace
