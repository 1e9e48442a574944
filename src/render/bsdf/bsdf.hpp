#pragma once
/// The BSDF of most surfaces: the metallic-roughness model of glTF 2.0, appendix B, opaque and
/// without layers. general.hpp has the others. Local coordinates as in parameters.hpp.

#include "render/bsdf/dielectric_bound.hpp"
#include "render/bsdf/ggx.hpp"
#include "render/bsdf/parameters.hpp"
#include "render/bsdf/schlick.hpp"

#include <microtrace/math.hpp>

#include <optional>

namespace microtrace::bsdf {

/// Diffuse reflection below specular reflection by GGX with Schlick's Fresnel term. It differs in
/// two points from the formulas of section B.3, which lose energy on rough metals and gain energy
/// on dielectrics at grazing angles: multiple scattering between microfacets is compensated (C.
/// Kulla and A. Conty, Revisiting physically based shading at Imageworks, 2017), and the diffuse
/// part is scaled by the energy that the specular part does not reflect, for both wo and wi (C.
/// Kelemen and L. Szirmay-Kalos, A microfacet based coupled specular-matte BRDF model with
/// importance sampling, 2001). The result is reciprocal and conserves energy.
class Bsdf {
 public:
  /// wo.z > 0. Only the parameters of plain surfaces are used.
  Bsdf(const Parameters& parameters, const Vec3& wo);

  [[nodiscard]] Evaluation evaluate(const Vec3& wi) const;

  /// u selects the direction, `lobe`, in [0, 1), the lobe. Nothing if the sample is absorbed.
  [[nodiscard]] std::optional<DirectionSample> sample(const Vec2& u, float lobe) const;

 private:
  [[nodiscard]] Evaluation above(const Vec3& wi, const Vec3& h) const;

  /// The fraction of light that the dielectric's specular part does not reflect.
  [[nodiscard]] float unreflected(const Albedo& albedo) const {
    return 1 - greatest_.albedo(albedo) - multiply_reflected_ * (1 - albedo.f1);
  }

  Vec3 wo_;
  Ggx ggx_;
  GgxAlbedo albedo_;
  Schlick specular_;          ///< of metal and dielectric combined
  GreatestSchlick greatest_;  ///< of the dielectric
  float multiply_reflected_;  ///< its multiple-scattering factor
  Vec3 diffuse_, multiple_;   ///< all factors that do not depend on wi
  float facet_probability_;   ///< probability of sampling a microfacet normal
};

}  // namespace microtrace::bsdf
