#pragma once
/// The parameters of a BSDF at one point, as collected by shading code. put_surface.hpp stores them
/// in lanes, and surface.hpp reads them there.

#include "render/bsdf/schlick.hpp"
#include "render/bsdf/thin_film.hpp"
#include "render/lanes/features.hpp"

#include <microtrace/math.hpp>

#include <optional>

namespace microtrace::bsdf {

/// The material parameters at one point, from textures and factors.
struct Parameters {
  Vec3 base_color{1};                 ///< linear Rec. 709, each in [0, 1]
  float metallic = 0, roughness = 1;  ///< each in [0, 1]
  Schlick<1> dielectric{};            ///< reflectance of the nonmetallic part
  /// The fraction of the light entering the dielectric that is transmitted
  /// (KHR_materials_transmission).
  float transmission = 0;
  /// The index of refraction below the surface divided by the index above; empty for thin walls,
  /// which don't refract.
  std::optional<float> eta{};
  /// The fraction of diffusely scattered light that is transmitted, and the color of this light
  /// (KHR_materials_diffuse_transmission).
  float diffuse_transmission = 0;
  Vec3 diffuse_transmission_color{1};
  /// The strength of anisotropy in [0, 1], and the direction in which highlights are stretched
  /// (KHR_materials_anisotropy). The direction is in world space and of any length. It is projected
  /// onto the tangent plane.
  float anisotropy = 0;
  Vec3 along{1, 0, 0};
  std::optional<ThinFilm<1>> film{};
};

/// The parameters of a surface that reflects, scatters and absorbs the light as a dielectric with
/// these parameters does, but transmits none.
[[nodiscard]] inline Parameters without_transmission(Parameters p) {
  p.base_color *= 1 - p.transmission;
  p.transmission = 0;
  return p;
}

/// Layers above a surface. By default, there are none.
struct Layers {
  Vec3 sheen{0};              ///< color, linear Rec. 709, each in [0, 1] (KHR_materials_sheen)
  float sheen_roughness = 0;  ///< in [0, 1]
  float coat = 0, coat_roughness = 0;  ///< each in [0, 1] (KHR_materials_clearcoat)
  LayerSide side = LayerSide::both;

  [[nodiscard]] bool are_visible() const { return coat != 0 || sheen != Vec3(0); }
};

/// The features that the BSDF needs for these parameters. `eta` matters only together with another
/// feature.
[[nodiscard]] inline Features features_of(const Parameters& p, const Layers& layers) {
  Features result{.is_anisotropic = p.anisotropy > 0,
                  .has_film = p.film.has_value(),
                  .transmits = p.transmission > 0 || p.diffuse_transmission > 0,
                  .layers = layers.are_visible() ? layers.side : LayerSide::none};
  result.refracts = result.index() != 0 && p.eta.has_value();
  result.transmits |= result.refracts;
  return result;
}

}  // namespace microtrace::bsdf
