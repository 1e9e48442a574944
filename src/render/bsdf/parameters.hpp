#pragma once
/// What is asked of a surface's scattering, and what it answers.
///
/// Local coordinates: z is the shading normal on the side of wo. Directions are unit vectors that
/// point away from the surface: wo to where the path comes from, wi to where it goes on, above or
/// below.

#include "render/bsdf/schlick.hpp"

#include <microtrace/math.hpp>

#include <optional>

namespace microtrace::bsdf {

/// Over part of a surface (KHR_materials_iridescence).
struct ThinFilm {
  float share = 1;        ///< in [0, 1]
  float ior = 1.3F;       ///< at least 1
  float thickness = 400;  ///< nanometres
};

/// What the textures and factors of a material come to at one point.
struct Parameters {
  Vec3 base_color{1};                 ///< linear Rec. 709, each in [0, 1]
  float metallic = 0, roughness = 1;  ///< each in [0, 1]
  Schlick dielectric{};               ///< of the part that is no metal
  /// Of the light that enters the dielectric: what goes through (KHR_materials_transmission).
  float transmission = 0;
  /// The index of refraction below over that above; nothing: a thin wall, which bends no light.
  std::optional<float> eta{};
  /// Of diffuse light: what goes through, and in which colour (KHR_materials_diffuse_transmission).
  float diffuse_transmission = 0;
  Vec3 diffuse_transmission_color{1};
  /// In [0, 1], and the direction of the longer highlights, of unit length
  /// (KHR_materials_anisotropy).
  float anisotropy = 0;
  Vec2 along{1, 0};
  std::optional<ThinFilm> film{};

  /// Whether Bsdf is all of it.
  [[nodiscard]] bool is_plain() const {
    return !film && anisotropy == 0 && transmission == 0 && diffuse_transmission == 0;
  }
};

/// f(wo, wi) |cos(theta_i)|, and the density with which sample() gives wi, per solid angle.
struct Evaluation {
  Vec3 value{0};
  float density = 0;
};

struct DirectionSample {
  Vec3 wi{0, 0, 1};
  Vec3 weight{0};     ///< value / density
  float density = 0;  ///< per solid angle
};

}  // namespace microtrace::bsdf
