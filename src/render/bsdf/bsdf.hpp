#pragma once
/// How most surfaces scatter light: the metallic-roughness model of glTF 2.0, appendix B, opaque
/// and bare. general.hpp has the rest. Local coordinates as in parameters.hpp.

#include "render/bsdf/dielectric_bound.hpp"
#include "render/bsdf/ggx.hpp"
#include "render/bsdf/parameters.hpp"
#include "render/bsdf/schlick.hpp"

#include <microtrace/math.hpp>

#include <optional>

namespace microtrace::bsdf {

/// Diffuse reflection under specular reflection by GGX with Schlick's Fresnel term. Two things
/// differ from the formulas of section B.3, which lose light on rough metals and return more than
/// comes where dielectrics are seen at a slant: what leaves the facets only after several
/// reflections is added (C. Kulla and A. Conty, Revisiting physically based shading at Imageworks,
/// 2017), and the diffuse part gets what the specular one leaves over in all, to wo and from wi
/// (C. Kelemen and L. Szirmay-Kalos, A microfacet based coupled specular-matte BRDF model with
/// importance sampling, 2001). So it is reciprocal, and white returns all light.
class Bsdf {
 public:
  /// wo.z > 0; of the parameters, those of a plain surface count.
  Bsdf(const Parameters& parameters, const Vec3& wo);

  [[nodiscard]] Evaluation evaluate(const Vec3& wi) const;

  /// u chooses the direction, `lobe`, in [0, 1), the part of the model. Nothing where light is
  /// lost.
  [[nodiscard]] std::optional<DirectionSample> sample(const Vec2& u, float lobe) const;

 private:
  [[nodiscard]] Evaluation above(const Vec3& wi, const Vec3& h) const;

  /// What the dielectric's specular part leaves over.
  [[nodiscard]] float left_over(const Albedo& albedo) const {
    return 1 - greatest_.albedo(albedo) - returned_ * (1 - albedo.white);
  }

  Vec3 wo_;
  Ggx ggx_;
  GgxAlbedo albedo_;
  Schlick specular_;          ///< of metal and dielectric together
  GreatestSchlick greatest_;  ///< the dielectric's
  float returned_;            ///< of it after several reflections
  Vec3 diffuse_, multiple_;   ///< all that does not depend on wi
  float facet_share_;         ///< of samples: by a facet's normal
};

}  // namespace microtrace::bsdf
