#pragma once
/// What a surface is made of: the metallic-roughness model of glTF 2.0, section 3.9.

#include <microtrace/math.hpp>
#include <microtrace/texture.hpp>

#include <optional>
#include <string>

namespace microtrace {

/// What the alpha of a base colour means (glTF 2.0, section 3.9.4).
enum class AlphaMode {
  opaque,  ///< nothing
  mask,    ///< the surface is there where alpha is at least the cutoff
  blend,   ///< the share of the surface's colour; what lies behind shows through
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
  Vec3 emissive{0};                                        ///< linear Rec. 709, not negative
  std::optional<TextureUse> emissive_texture{};            ///< sRGB
};

}  // namespace microtrace
