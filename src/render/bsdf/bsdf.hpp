#pragma once
/// How a surface scatters light: the metallic-roughness model of glTF 2.0, appendix B.
///
/// Local coordinates: z is the shading normal on the side of wo. Directions are unit vectors that
/// point away from the surface: wo to where the path comes from, wi to where it goes on.

#include "render/bsdf/ggx.hpp"

#include <microtrace/math.hpp>

#include <optional>

namespace microtrace::bsdf {

/// What the textures and factors of a material come to at one point.
struct Parameters {
  Vec3 base_color{1};                 ///< linear Rec. 709, each in [0, 1]
  float metallic = 0, roughness = 1;  ///< each in [0, 1]
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

/// Diffuse reflection under specular reflection by GGX with Schlick's Fresnel term. Two things
/// differ from the formulas of section B.3, which lose light on rough metals and return more than
/// comes where dielectrics are seen at a slant: what leaves the facets only after several
/// reflections is added (C. Kulla and A. Conty, Revisiting physically based shading at Imageworks,
/// 2017), and the diffuse part gets what the specular one leaves over in all, to wo and from wi
/// (C. Kelemen and L. Szirmay-Kalos, A microfacet based coupled specular-matte BRDF model with
/// importance sampling, 2001). So it is reciprocal, and white returns all light.
class Bsdf {
 public:
  /// wo.z > 0.
  Bsdf(const Parameters& parameters, const Vec3& wo);

  /// wi of any direction; below the surface it is 0.
  [[nodiscard]] Evaluation evaluate(const Vec3& wi) const;

  /// u chooses the direction, `lobe`, in [0, 1), the part of the model. Nothing where the direction
  /// goes below the surface: such light is lost.
  [[nodiscard]] std::optional<DirectionSample> sample(const Vec2& u, float lobe) const;

 private:
  [[nodiscard]] Evaluation evaluate(const Vec3& wi, const Vec3& h) const;
  /// What the dielectric's specular part leaves over.
  [[nodiscard]] float left_over(const Albedo& albedo) const {
    return 1 - albedo.edge - dielectric_white_ * albedo.white -
           dielectric_rest_ * (1 - albedo.white) + dielectric_white_ * albedo.edge;
  }

  Vec3 wo_;
  Ggx ggx_;
  GgxAlbedo albedo_;
  float dielectric_white_, dielectric_rest_;  ///< F0; what is returned of several reflections
  Vec3 f0_;
  Vec3 diffuse_;          ///< all that does not depend on wi
  Vec3 multiple_;         ///< the same, of several reflections
  float specular_share_;  ///< of samples
};

}  // namespace microtrace::bsdf
