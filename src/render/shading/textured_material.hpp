#pragma once
/// Materials with their textures, and the points at which they are evaluated.

#include "render/bsdf/parameters.hpp"
#include "render/lanes/textured_lanes.hpp"
#include "render/media/medium.hpp"
#include "render/shading/points/surface_point.hpp"
#include "render/textures/texture_map.hpp"
#include "scene/material_textures.hpp"

#include <microtrace/material.hpp>
#include <microtrace/texture.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace microtrace {

struct ShadingPoint;

/// A use of a texture by a material.
struct TextureSlot {
  const TextureMap* map = nullptr;  ///< null if there is no texture
  const TextureUse* use = nullptr;
  float width_scale = 1;  ///< of footprint widths by use->texture_from_uv
  /// True if its texel address equals that of TexturedMaterial::layout.
  bool shares_address = false;

  /// The linear texel value; white if there is no texture.
  [[nodiscard]] Vec4 at(const ShadingPoint& point) const {
    return map == nullptr ? Vec4(1) : look_up(point);
  }
  [[nodiscard]] TexelAddress<1> texel_address(const ShadingPoint& point) const;
  /// The texel address at a point of the mesh's texture coordinates. `width` is the footprint's
  /// width in these coordinates.
  [[nodiscard]] TexelAddress<1> texel_address(const Vec2& uv, float width) const;
  /// True if texels are certainly larger than a footprint on a triangle, so that look-ups use no
  /// other filter than for points. `part` is the square of the footprint's width divided by twice
  /// the triangle's area.
  [[nodiscard]] bool is_magnified(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners,
                                  double part) const;

 private:
  [[nodiscard]] Vec4 look_up(const ShadingPoint& point) const;
};

/// The input of a BSDF at a point.
struct BsdfInput {
  bsdf::Parameters parameters;
  bsdf::Layers layers;
  bsdf::Features features;

  BsdfInput(const bsdf::Parameters& p, const bsdf::Layers& l)
      : parameters(p), layers(l), features(features_of(p, l)) {}
};

/// A material with its textures.
struct TexturedMaterial {
  /// The textures that most materials have.
  static constexpr std::array kFrequent = {MaterialTexture::base_color,
                                           MaterialTexture::metallic_roughness,
                                           MaterialTexture::normal, MaterialTexture::emissive};

  const Material* material = nullptr;
  std::array<TextureSlot, static_cast<std::size_t>(MaterialTexture::count)> slots{};
  /// The slot whose texel address is reused by every slot with shares_address. Often these are all
  /// slots.
  TextureSlot layout{};
  Medium medium{};  ///< the enclosed medium, if encloses_medium()
  /// True if the emitted radiance is the same everywhere on the front, and no part is transparent.
  bool has_constant_emission = false;
  bool has_open_back = false;  ///< true if Backfaces::pass lets light pass through the back
  /// As has_open_back, but only where the textures of all transmission are 0.
  bool has_open_opaque_parts = false;
  /// True if constant_but_textures is set, the roughness is not given as glossiness, and the
  /// material is neither unlit nor emissive, except by a texture.
  bool is_simple = false;
  bool is_textured = false;  ///< true if the material has textures
  /// True if the material has textures or an alpha mode, so that points differ.
  bool varies = false;
  bool has_back = false;  ///< has_back(*material)
  /// True if coverage() depends only on alpha for rays other than camera rays, and there are no
  /// open opaque parts.
  bool depends_on_alpha = false;
  /// True if the surface is a thin wall that is too smooth to spread the light that crosses it.
  /// Light then crosses it in straight lines, and its BSDF only reflects.
  bool is_clear = false;
  /// True if coverage() is also 0 or 1 everywhere, and the surface isn't clear.
  bool is_opaque_if_visible = false;
  /// True if coverage() is also 1 everywhere.
  bool is_opaque = false;
  /// The BSDF's input for white texels, if it depends on nothing but textures of kFrequent with
  /// texture coordinates of set 0 on meshes without vertex colors.
  std::optional<BsdfInput> constant_but_textures{};
  /// The material for kernels. Except for camera rays, emission and alpha are those of
  /// ShadingPoint::unfiltered().
  struct KernelSurfaces {
    TexturedSurface from_camera, from_others;
  };
  /// Set if constant_but_textures is set and either the material varies or meshes with it have
  /// vertex colors.
  std::shared_ptr<const KernelSurfaces> kernel_surfaces{};

  [[nodiscard]] TextureSlot& operator[](MaterialTexture texture) {
    return slots[static_cast<std::size_t>(texture)];
  }
  [[nodiscard]] const TextureSlot& operator[](MaterialTexture texture) const {
    return slots[static_cast<std::size_t>(texture)];
  }

  /// True if a texture is not one of kFrequent, or uses other texture coordinates than set 0.
  [[nodiscard]] bool has_rare_textures() const;
  /// Prefetches the texels of all slots with shares_address.
  void fetch(const TexelAddress<1>& address) const;

  [[nodiscard]] bool is_emissive() const { return microtrace::is_emissive(*material); }
};

/// A shading point, its material, and the width of its footprint.
struct ShadingPoint {
  SurfacePoint at;
  const TexturedMaterial* look = nullptr;
  float width = 0;  ///< footprint width in world space
  /// The texel address that slots share, if it has been computed.
  std::optional<TexelAddress<1>> texel_address{};

  /// The point with a footprint of width 0.
  [[nodiscard]] ShadingPoint unfiltered() const { return {.at = at, .look = look}; }
};

/// True if the back of the material is visible, from behind or from inside its medium.
[[nodiscard]] inline bool has_back(const Material& m) {
  return m.double_sided || encloses_medium(m);
}

}  // namespace microtrace
