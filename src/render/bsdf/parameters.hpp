#pragma once
/// Input and output of BSDFs.
///
/// Local coordinates: z is the shading normal on the side of wo. Directions are unit vectors that
/// point away from the surface: wo to the previous vertex of the path, wi to the next, above or
/// below.

#include "render/bsdf/schlick.hpp"

#include <microtrace/math.hpp>

#include <optional>

namespace microtrace::bsdf {

/// Covers part of a surface (KHR_materials_iridescence).
struct ThinFilm {
  float share = 1;        ///< covered fraction, in [0, 1]
  float ior = 1.3F;       ///< at least 1
  float thickness = 400;  ///< nanometers

  bool operator==(const ThinFilm&) const = default;
};

/// The material parameters at one point, from textures and factors.
struct Parameters {
  Vec3 base_color{1};                 ///< linear Rec. 709, each in [0, 1]
  float metallic = 0, roughness = 1;  ///< each in [0, 1]
  Schlick dielectric{};               ///< reflectance of the nonmetallic part
  /// The fraction of the light entering the dielectric that is transmitted
  /// (KHR_materials_transmission).
  float transmission = 0;
  /// The index of refraction below divided by that above; empty for a thin wall, which doesn't
  /// refract.
  std::optional<float> eta{};
  /// The fraction of diffuse light that is transmitted, and its color
  /// (KHR_materials_diffuse_transmission).
  float diffuse_transmission = 0;
  Vec3 diffuse_transmission_color{1};
  /// Strength in [0, 1], and the direction of the longer highlights, of unit length
  /// (KHR_materials_anisotropy).
  float anisotropy = 0;
  Vec2 along{1, 0};
  std::optional<ThinFilm> film{};

  bool operator==(const Parameters&) const = default;

  /// Whether Bsdf implements these parameters: the first four below. The other three have no effect
  /// alone. A parameter that is not listed here is not plain.
  [[nodiscard]] bool is_plain() const {
    const Parameters standard;
    Parameters rest = *this;
    rest.base_color = standard.base_color;
    rest.metallic = standard.metallic;
    rest.roughness = standard.roughness;
    rest.dielectric = standard.dielectric;
    rest.eta = standard.eta;
    rest.diffuse_transmission_color = standard.diffuse_transmission_color;
    rest.along = standard.along;
    return rest == standard;
  }
};

/// f(wo, wi) |cos(theta_i)|, and the pdf with which sample() returns wi, per solid angle.
struct Evaluation {
  Vec3 value{0};
  float pdf = 0;
};

struct DirectionSample {
  Vec3 wi{0, 0, 1};
  Vec3 weight{0};  ///< value / pdf
  float pdf = 0;   ///< per solid angle
};

}  // namespace microtrace::bsdf
