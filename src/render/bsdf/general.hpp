#pragma once
/// How any surface scatters light: that of bsdf.hpp with what the extensions add to it, bare or
/// under layers. Local coordinates as in parameters.hpp.

#include "render/bsdf/anisotropic_albedo.hpp"
#include "render/bsdf/anisotropic_ggx.hpp"
#include "render/bsdf/cover.hpp"
#include "render/bsdf/dielectric_bound.hpp"
#include "render/bsdf/ggx.hpp"
#include "render/bsdf/parameters.hpp"
#include "render/bsdf/refraction_loss.hpp"

#include <microtrace/math.hpp>

#include <optional>

namespace microtrace::bsdf {

/// Bsdf where the parameters are plain and there is no cover.
///
/// What facets send through a thin wall in several turns goes where cosines lead, as what they
/// reflect in several does: together that is all that single ones lose.
///
/// Light that is refracted (B. Walter et al., Microfacet models for refraction, 2007) is counted
/// without the square of the index: radiance divided by it stays the same on its way in and out.
///
/// Microfacets is Ggx or AnisotropicGgx.
template <typename Microfacets>
class GeneralBsdf {
 public:
  /// wo.z > 0. The cover, here and below: what lies over it, if anything does and eta is nothing.
  GeneralBsdf(const Parameters& parameters, const Cover* cover, const Vec3& wo);

  [[nodiscard]] Evaluation evaluate(const Cover* cover, const Vec3& wi) const;

  /// u chooses the direction, `lobe`, in [0, 1), the part of the model; evaluate() tells the
  /// density.
  [[nodiscard]] Vec3 direction(const Vec2& u, float lobe) const;

 private:
  using MicrofacetAlbedo = typename Microfacets::DirectionalAlbedo;

  /// What facets that reflect all in one turn leave, and what the dielectric's leave to lie below.
  struct Left {
    float white, diffuse;
  };
  [[nodiscard]] Left left(const Albedo& albedo, float passed, const Albedo& missed) const;
  [[nodiscard]] Left left(const Cover* cover, const Vec3& w) const;
  [[nodiscard]] Left mean_left(const Cover* cover) const;

  [[nodiscard]] Evaluation above(const Cover* cover, const Vec3& wi) const;
  [[nodiscard]] Evaluation below(const Cover* cover, const Vec3& wi) const;
  void refract(const Vec3& wi, Evaluation& e) const;
  void add_refraction_loss(const Parameters& p);

  /// What facets reflect that wo meets at that cosine, and what of the dielectric's light goes on.
  struct Shares {
    Vec3 reflected, entering;
  };
  [[nodiscard]] Shares shares(float cosine) const;
  [[nodiscard]] Vec3 reflectance(const Schlick& schlick, float cosine) const;
  /// Of samples at a facet those that are reflected.
  [[nodiscard]] float reflected_share(const Shares& shares) const;
  /// Sets what lies under the film; what it reflects head on, about.
  Vec3 add_film(const Schlick& schlick);

  Vec3 wo_;
  Microfacets ggx_;
  MicrofacetAlbedo albedo_;
  Schlick dielectric_, metal_, specular_;  ///< the last of both together
  std::optional<ThinFilm> film_;
  float metallic_;
  GreatestSchlick greatest_;  ///< the dielectric's
  float returned_;            ///< of it after several reflections
  float passed_;              ///< by the cover
  // All that does not depend on wi: diffuse light above and below, what comes after several
  // reflections above and below, what goes through. Of bent light, what comes after several turns.
  Vec3 diffuse_, diffuse_below_, multiple_, multiple_below_, transmitted_;
  std::optional<float> eta_;
  RefractionLoss loss_;  ///< where light is bent
  Vec3 lost_{0}, lost_below_{0};
  // Of samples: by a facet's normal, and of the others those below.
  float facet_share_, below_share_;
};

extern template class GeneralBsdf<Ggx>;
extern template class GeneralBsdf<AnisotropicGgx>;

}  // namespace microtrace::bsdf
