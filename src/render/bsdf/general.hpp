#pragma once
/// The BSDF of any surface: bsdf.hpp and the material extensions, with or without layers. Local
/// coordinates as in parameters.hpp.

#include "render/bsdf/anisotropic_albedo.hpp"
#include "render/bsdf/anisotropic_ggx.hpp"
#include "render/bsdf/coating.hpp"
#include "render/bsdf/dielectric_bound.hpp"
#include "render/bsdf/ggx.hpp"
#include "render/bsdf/parameters.hpp"
#include "render/bsdf/refraction_loss.hpp"

#include <microtrace/math.hpp>

#include <optional>

namespace microtrace::bsdf {

/// Equals Bsdf if the parameters are plain and there is no coating.
///
/// The multiple-scattering lobe of transmission through thin walls is cosine-distributed, as that
/// of reflection. Together the two lobes compensate all energy that single scattering loses.
///
/// Refraction (B. Walter et al., Microfacet models for refraction, 2007) omits the squared index of
/// refraction: radiance divided by it is the same before entering and after leaving.
///
/// Microfacets is Ggx or AnisotropicGgx.
template <typename Microfacets>
class GeneralBsdf {
 public:
  /// wo.z > 0. `coating` is the coating above the surface, if there is one and eta is empty.
  GeneralBsdf(const Parameters& parameters, const Coating* coating, const Vec3& wo);

  [[nodiscard]] Evaluation evaluate(const Coating* coating, const Vec3& wi) const;

  /// u selects the direction, `lobe`, in [0, 1), the lobe; evaluate() returns the pdf.
  [[nodiscard]] Vec3 direction(const Vec2& u, float lobe) const;

 private:
  using MicrofacetAlbedo = typename Microfacets::DirectionalAlbedo;

  /// Energy not reflected by facets in single scattering for F = 1, and energy that the
  /// dielectric's facets leave for the diffuse part.
  struct Left {
    float f1, diffuse;
  };
  [[nodiscard]] Left left(const Albedo& albedo, float transmittance, const Albedo& deficit) const;
  [[nodiscard]] Left left(const Coating* coating, const Vec3& w) const;
  [[nodiscard]] Left mean_left(const Coating* coating) const;

  [[nodiscard]] Evaluation above(const Coating* coating, const Vec3& wi) const;
  [[nodiscard]] Evaluation below(const Coating* coating, const Vec3& wi) const;
  void refract(const Vec3& wi, Evaluation& e) const;
  void add_refraction_loss(const Parameters& p);

  /// The fractions of light that facets reflect at this cosine, and that enters the dielectric.
  struct Shares {
    Vec3 reflected, entering;
  };
  [[nodiscard]] Shares shares(float cosine) const;
  [[nodiscard]] Vec3 reflectance(const Schlick& schlick, float cosine) const;
  /// The probability of reflection when a facet is sampled.
  [[nodiscard]] float reflection_probability(const Shares& shares) const;
  /// Sets the base of the film; returns its approximate reflectance at normal incidence.
  Vec3 add_film(const Schlick& schlick);

  Vec3 wo_;
  Microfacets ggx_;
  MicrofacetAlbedo albedo_;
  Schlick dielectric_, metal_, specular_;  ///< the last for both combined
  std::optional<ThinFilm> film_;
  float metallic_;
  GreatestSchlick greatest_;  ///< of the dielectric
  float multiply_reflected_;  ///< its multiple-scattering factor
  float transmittance_;       ///< transmittance of the coating
  // All factors that do not depend on wi: diffuse above and below, multiple scattering above and
  // below, transmission. For refraction, its multiple scattering.
  Vec3 diffuse_, diffuse_below_, multiple_, multiple_below_, transmitted_;
  std::optional<float> eta_;
  RefractionLoss loss_;  ///< for refraction
  Vec3 lost_{0}, lost_below_{0};
  // Probabilities of sampling a facet normal, and else of sampling below the surface.
  float facet_probability_, below_probability_;
};

extern template class GeneralBsdf<Ggx>;
extern template class GeneralBsdf<AnisotropicGgx>;

}  // namespace microtrace::bsdf
