#pragma once
/// The BSDF below the layers, for N lanes, in the local coordinates of surface.hpp.

#include "render/bsdf/anisotropic_albedo.hpp"
#include "render/bsdf/anisotropic_ggx.hpp"
#include "render/bsdf/coating.hpp"
#include "render/bsdf/ggx_albedo.hpp"
#include "render/bsdf/multiple_scattering.hpp"
#include "render/bsdf/refraction_loss.hpp"
#include "render/bsdf/surface.hpp"
#include "render/lanes/features.hpp"
#include "scene/math/luminance.hpp"
#include "simd/gather.hpp"

namespace microtrace::bsdf {

/// The metallic-roughness model of glTF 2.0, appendix B, with the material extensions. Diffuse
/// reflection lies below specular reflection by GGX with Schlick's Fresnel term. The formulas of
/// section B.3 lose energy on rough metals and gain energy on dielectrics at grazing angles. This
/// class differs from them in two ways. It compensates multiple scattering between microfacets (C.
/// Kulla and A. Conty, Revisiting physically based shading at Imageworks, 2017). It scales the
/// diffuse part by the energy that the specular part does not reflect, for both wo and wi (C.
/// Kelemen and L. Szirmay-Kalos, A microfacet based coupled specular-matte BRDF model with
/// importance sampling, 2001). The result is reciprocal and conserves energy.
///
/// The multiple-scattering lobes of reflection and of transmission through thin walls are
/// cosine-distributed. Together they compensate all energy that single scattering loses.
///
/// Refraction (B. Walter et al., Microfacet models for refraction, 2007) does not scale radiance by
/// the squared relative index of refraction, because the factors for entering and leaving a volume
/// cancel.
///
/// With Features::is_spec, the formulas are those of the specification: the diffuse part and the
/// transmitted light are scaled by what the dielectric's microfacet with the half vector does not
/// reflect, in the brightest color channel, and nothing is compensated.
///
/// Parts is a struct with the member types FeaturesType (Features or PlainFeatures), Microfacets
/// (Ggx<N> or AnisotropicGgx<N>) and MicrofacetAlbedo.
template <int N, class Parts>
class BaseBsdf {
 public:
  using F = Float<N>;
  using V = Floats3<N>;
  using FeaturesType = typename Parts::FeaturesType;
  using Microfacets = typename Parts::Microfacets;

  /// wo.z must be positive. `coatings` must outlive this object.
  BaseBsdf(const FeaturesType& features, const Surface<N>& surface, const Microfacets& microfacets,
           const Coatings<N>& coatings, const V& wo);

  /// `h` must be half_vector(wi).
  [[nodiscard]] Evaluation<N> evaluate(const V& wi, const V& h) const;

  /// The fraction of light that crosses a thin wall toward wo in a straight line if the wall is
  /// smooth.
  [[nodiscard]] V crossing_light() const { return shares(wo_.z).entering * transmittance_; }

  /// The unit half vector of wo and wi. A wi below the surface is first mirrored to the upper side.
  [[nodiscard]] V half_vector(const V& wi) const {
    return unit<N>(wo_ + V{wi.x, wi.y, magnitude(wi.z)});
  }

  struct Direction {
    V wi;  ///< zero if the sample is absorbed
    V h;   ///< half_vector(wi)
  };
  /// Samples a direction. `lobe`, in [0, 1), selects the lobe, and `u` the direction. evaluate()
  /// returns the pdf.
  [[nodiscard]] Direction sample(const Floats2<N>& u, const F& lobe) const;

 private:
  static constexpr bool kIsPlain = __is_same(FeaturesType, PlainFeatures);
  static constexpr int kFilmNodes = 9;

  /// The fractions of light that a microfacet reflects, and that enter the dielectric.
  struct Shares {
    V reflected, entering;
    F diffuse;   ///< reaches the diffuse part; 0 without Features::is_spec
    F returned;  ///< the fraction of the entering light that a coating behind reflects
  };

  /// The energy that single scattering loses for F = 1, and the energy that the dielectric's
  /// microfacets pass on to the diffuse part.
  struct Left {
    F f1, diffuse;
  };
  /// The Fresnel term of the dielectric for directions with cosine z.
  [[nodiscard]] GreatestSchlick<N> dielectric_at(const F& z) const;
  /// Interpolates between reflectances of the film's nodes for directions with cosine z.
  [[nodiscard]] F film_f0_at(const F (&f0)[kFilmNodes], const F& z) const;
  /// Bounds of the film's reflectances on the facets that are seen at this mean angle of incidence.
  [[nodiscard]] typename RefractionLoss<N>::F0Range film_f0_range(const F& cosine) const;
  /// The fraction of light that the dielectric's microfacets do not reflect.
  [[nodiscard]] F unreflected(const GreatestSchlick<N>& dielectric, const Albedo<N>& albedo) const {
    return 1 - dielectric.albedo(albedo) - multiply_reflected_ * (1 - albedo.f1);
  }
  [[nodiscard]] Left left(const GreatestSchlick<N>& dielectric, const Albedo<N>& albedo) const;
  [[nodiscard]] Left left(const GreatestSchlick<N>& dielectric, const Albedo<N>& albedo,
                          const F& transmittance, const Albedo<N>& deficit) const;
  [[nodiscard]] Left left(const Coating<N>* coating, const V& w) const;
  [[nodiscard]] Left mean_left(const Coating<N>* coating) const;
  /// The factors of wi. `shares` are those of the microfacet whose normal is the half vector.
  [[nodiscard]] Left left(const Coating<N>* coating, const V& wi, const Shares& shares) const {
    return features_.is_spec ? Left{.f1 = F{}, .diffuse = shares.diffuse} : left(coating, wi);
  }
  /// The coating on the upper or lower side; null if there is none.
  [[nodiscard]] const Coating<N>* coating_above() const {
    return kIsPlain ? nullptr : coatings_.above;
  }
  [[nodiscard]] const Coating<N>* coating_below() const {
    return kIsPlain ? nullptr : coatings_.below;
  }
  /// True if light from the medium above meets a coating behind the surface. What the coating
  /// reflects of this light stays above.
  [[nodiscard]] bool is_coated_behind() const {
    return features_.refracts && coating_above() == nullptr && coating_below() != nullptr;
  }
  /// G2 / (4 z_o z_i) for a wi above the surface.
  [[nodiscard]] F visibility(const V& wi) const {
    return features_.is_spec ? ggx_.spec_visibility(wo_, wi) : ggx_.visibility(wo_, wi);
  }

  [[nodiscard]] Evaluation<N> above(const V& wi, const V& h) const;
  [[nodiscard]] Evaluation<N> below(const V& wi, const V& h) const;
  void refract(const V& wi, const F& transmittance, Evaluation<N>& e) const;
  /// Removes the dielectric from the opaque part of a refracting surface where wo is in the denser
  /// medium: pigments that touch the medium reflect its light without a boundary in between. `here`
  /// and `mean` are Left::diffuse for wo and on average, and `mean_below` is the average below the
  /// surface.
  void uncover_opaque_part(const Surface<N>& surface, const F& here, const F& mean,
                           const F& mean_below);
  /// Reflectances at normal incidence.
  struct HeadOn {
    V dielectric, metal;
  };
  /// The fraction of the energy lost by single scattering that metal and dielectric reflect.
  [[nodiscard]] V multiply_scattered(const Surface<N>& surface, const V& f0, const HeadOn& parts,
                                     const F& white_mean) const;
  void add_transmission(const Surface<N>& surface, const V& f0, const F& white_mean,
                        const F& several);
  void add_refraction_loss(const Surface<N>& surface);

  /// The angle of incidence for Schlick's term, which is that in the medium with the lower index of
  /// refraction.
  struct Incidence {
    F cosine;
    F is_total;  ///< 1 for total reflection, otherwise 0
  };
  [[nodiscard]] Incidence incidence(const F& cosine) const;
  [[nodiscard]] Shares shares(const F& cosine) const;
  [[nodiscard]] Shares spec_shares(const F& cosine) const;
  [[nodiscard]] V reflectance(const Schlick<N>& schlick, const F& cosine) const;
  /// The reflectance of metal and dielectric combined.
  [[nodiscard]] V reflectance(const F& cosine) const;
  /// The fraction of the light through the microfacet with normal h that a coating behind the
  /// surface reflects toward wi.
  [[nodiscard]] F returned(const V& wi, const V& h) const;
  /// The probability of sampling reflection, given a sampled microfacet normal.
  [[nodiscard]] F reflection_probability(const Shares& shares) const;
  /// Sets the dielectric's reflectance with the film and `parts`, and returns the approximate
  /// reflectance of metal and dielectric combined at normal incidence.
  V add_film(const F& roughness, HeadOn& parts);
  /// The transmittance of the coatings for wo and a wi on the side of `coating`, which may be null:
  /// the smaller of both.
  [[nodiscard]] F transmittance(const Coating<N>* coating, const V& wi) const {
    return coating == nullptr ? transmittance_
                              : smaller_of(transmittance_, coating->transmittance(wi));
  }

  FeaturesType features_;
  V wo_;
  Microfacets ggx_;
  typename Parts::MicrofacetAlbedo albedo_;
  Schlick<N> specular_;          ///< Fresnel term of metal and dielectric combined
  GreatestSchlick<N> greatest_;  ///< Fresnel term of the dielectric
  F multiply_reflected_;         ///< multiple-scattering factor of the dielectric
  V diffuse_, multiple_;         ///< products of all factors that do not depend on wi
  F facet_probability_;          ///< probability of sampling a microfacet normal
  // The members below are set only if their feature is present.
  Coatings<N> coatings_;
  F transmittance_;  ///< transmittance of the coating above for wo; 1 if there is none
  Schlick<N> dielectric_, metal_;
  ThinFilm<N> film_;
  /// The dielectric with its film reflects like Schlick's term with these reflectances at normal
  /// incidence, for equidistant cosines in [0, 1].
  F film_f0_[kFilmNodes], film_least_[kFilmNodes];  ///< of the brightest and the darkest channel
  F film_mean_least_;
  F least_square_, on_facets_;  ///< see dielectric_at()
  F metallic_, eta_;
  V diffuse_below_, multiple_below_, transmitted_;
  F bare_;          ///< fraction of the surface that uncover_opaque_part() uncovers
  V bare_diffuse_;  ///< the value of its diffuse reflection
  /// The factors of light that diffuse transmission reflects, and of light that it transmits.
  V bare_kept_;
  F bare_through_;
  RefractionLoss<N> loss_;
  V lost_, lost_below_;  ///< energy compensation of refraction, above and below
  F below_probability_;  ///< probability of sampling below the surface if no microfacet normal is
                         ///< sampled
};

}  // namespace microtrace::bsdf
