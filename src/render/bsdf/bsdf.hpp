#pragma once
/// The BSDF of any surface, with or without layers, for N lanes, in the local coordinates of
/// surface.hpp.

#include "render/bsdf/base/base_bsdf.hpp"
#include "render/bsdf/base/base_bsdf_lobes.hpp"
#include "render/bsdf/base/base_bsdf_setup.hpp"
#include "render/bsdf/coating.hpp"
#include "render/bsdf/surface.hpp"
#include "render/lanes/features.hpp"

namespace microtrace::bsdf {

template <int N>
struct PlainParts {
  using FeaturesType = PlainFeatures;
  using Microfacets = Ggx<N>;
  using MicrofacetAlbedo = GgxAlbedo<N>;
};
template <int N>
struct IsotropicParts {
  using FeaturesType = Features;
  using Microfacets = Ggx<N>;
  using MicrofacetAlbedo = GgxAlbedo<N>;
};
template <int N>
struct AnisotropicParts {
  using FeaturesType = Features;
  using Microfacets = AnisotropicGgx<N>;
  using MicrofacetAlbedo = AnisotropicGgxAlbedo<N>;
};

/// A BaseBsdf below a sheen layer, which is below a clear coat. Refracting surfaces have layers
/// only on the outside.
///
/// With Features::is_spec, the layers are those of KHR_materials_clearcoat and KHR_materials_sheen:
/// the coat's Fresnel term depends on wo only, which makes coated surfaces not reciprocal.
template <int N, class Parts>
class Bsdf {
 public:
  using F = Float<N>;
  using V = Floats3<N>;
  using FeaturesType = typename Parts::FeaturesType;

  /// wo.z must be positive. `coating` must outlive this object; it is null if the features include
  /// no layers.
  Bsdf(const FeaturesType& features, const Surface<N>& surface, const Coating<N>* coating,
       const V& wo);

  [[nodiscard]] Evaluation<N> evaluate(const V& wi) const {
    return evaluate(wi, base_.half_vector(wi));
  }

  /// The fraction of light that crosses a thin wall toward wo in a straight line if the wall is
  /// smooth.
  [[nodiscard]] V crossing_light() const {
    V value = base_.crossing_light();
    if (features_.is_spec && features_.layers != LayerSide::none) spec_absorb(-wo_, value);
    return value;
  }

  struct Sample {
    V wi;  ///< zero if the sample is absorbed
    Evaluation<N> evaluation;
  };
  /// Samples a direction. `lobe`, in [0, 1), selects the lobe, and `u` the direction. The pdf is 0
  /// if the sample is absorbed.
  [[nodiscard]] Sample sample(const Floats2<N>& u, const F& lobe) const;

 private:
  using Base = BaseBsdf<N, Parts>;

  [[nodiscard]] static auto microfacets(const Surface<N>& s) {
    if constexpr (__is_same(typename Parts::Microfacets, Ggx<N>))
      return Ggx<N>(s.roughness);
    else
      return AnisotropicGgx<N>(s.roughness, s.anisotropy, s.along);
  }
  /// The coatings through which the base is seen, unless the specification's formulas are used.
  [[nodiscard]] Coatings<N> base_coatings() const {
    if (features_.is_spec) return {};
    return {features_.layers == LayerSide::below ? nullptr : coating_,
            features_.layers == LayerSide::above ? nullptr : coating_};
  }
  /// True if there are layers on the side of wo.
  [[nodiscard]] bool has_layers_above() const {
    return features_.layers == LayerSide::both || features_.layers == LayerSide::above;
  }
  /// The lanes in which the coat may reflect light to wi.
  [[nodiscard]] auto is_reached(const V& wi) const {
    return wi.z > least_reflected_cosine(features_);
  }
  [[nodiscard]] Evaluation<N> evaluate(const V& wi, const V& h) const;
  void spec_absorb(const V& wi, V& value) const;
  void add_sheen(const V& wi, const V& h, Evaluation<N>& e) const;
  void add_coat(const V& wi, const V& h, Evaluation<N>& e) const;

  FeaturesType features_;
  V wo_;
  const Coating<N>* coating_;
  Base base_;
  // The members below are set only if there are layers on the side of wo, unless noted
  // otherwise.
  V sheen_;
  F coat_;
  F coat_transmittance_;                    // transmittance of the coat for wo
  F sheen_probability_, coat_probability_;  // sampling probabilities
};

template <int N, class Parts>
Bsdf<N, Parts>::Bsdf(const FeaturesType& features, const Surface<N>& surface,
                     const Coating<N>* coating, const V& wo)
    : features_(features),
      wo_(wo),
      coating_(coating),
      base_(features, surface, microfacets(surface), base_coatings(), wo) {
  if (!has_layers_above()) return;
  sheen_ = surface.sheen;
  coat_ = surface.coat;
  coat_transmittance_ =
      features_.is_spec ? F(1 - coating->spec_coat_weight(wo)) : coating->coat_transmittance(wo);
  // Samples layers in proportion to their approximate albedos, with a minimum probability.
  const F greatest = coating->greatest_sheen(), least = all<N>(0.1F);
  const F of_sheen = larger_of(F(0.5F * greatest * coating->sheen().albedo(wo.z)), least);
  const F of_coat = larger_of(F(0.8F * (1 - coat_transmittance_)), least);
  coat_probability_ = coat_ > 0 ? of_coat : F{};
  sheen_probability_ = (greatest > 0 ? of_sheen : F{}) * (1 - coat_probability_);
}

template <int N, class Parts>
void Bsdf<N, Parts>::add_sheen(const V& wi, const V& h, Evaluation<N>& e) const {
  const auto has_sheen = (coating_->greatest_sheen() > 0) & (wi.z > 0);
  if (!any(has_sheen)) return;
  const SheenLobe<N>& sheen = coating_->sheen();
  F reflected;
  if (features_.is_spec) {
    reflected = sheen.published_reflectance(wo_, wi, h) * coat_transmittance_;
  } else {
    const F through = smaller_of(coat_transmittance_, coating_->coat_transmittance(wi));
    reflected = sheen.reflectance(wo_, wi, h) * through;
  }
  const V value = sheen_ * (reflected * wi.z);
  e.value = select3(has_sheen, V(e.value + value), e.value);
  e.pdf = has_sheen ? e.pdf + sheen_probability_ * sheen.pdf(wi.z) : e.pdf;
}

template <int N, class Parts>
void Bsdf<N, Parts>::add_coat(const V& wi, const V& h, Evaluation<N>& e) const {
  const Frame<N>& frame = coating_->coat_frame();
  const V o = frame.to_local(wo_), i = frame.to_local(wi);
  const auto has_coat = (coat_ != 0) & (o.z > 0) & (i.z > 0) & is_reached(wi);
  if (!any(has_coat)) return;
  // The half vector of the base is that of the mirrored direction where wi is below its horizon.
  const V half = any(wi.z < 0) ? select3(wi.z < 0, unit<N>(wo_ + wi), h) : h;
  const Ggx<N>& facets = coating_->coat();
  const F d = facets.distribution(frame.to_local(half));
  F f;
  if (features_.is_spec) {
    f = coating_->spec_coat_weight(wo_) * d * facets.spec_visibility(o, i);
  } else {
    const F reflected = Coating<N>::fresnel()(smaller_of(dot(wo_, half), all<N>(1))).x;
    f = coat_ * reflected * d * facets.visibility(o.z, i.z);
  }
  // The cosine with the coat's own normal makes the coat independent of the base's normal.
  e.value = select3(has_coat, V(e.value + all3<N>(f * i.z)), e.value);
  e.pdf = has_coat ? e.pdf + coat_probability_ * facets.reflected_pdf(o.z, d) : e.pdf;
}

template <int N, class Parts>
void Bsdf<N, Parts>::spec_absorb(const V& wi, V& value) const {
  const F of_sheen = coating_->sheen_transmittance(magnitude(wi.z));
  if (has_layers_above()) {
    value *= coat_transmittance_ * smaller_of(coating_->sheen_transmittance(wo_.z), of_sheen);
  } else {
    // The view direction of the layers is that of the light that leaves the medium.
    const F through = (1 - coating_->spec_coat_weight(wi)) * of_sheen;
    value *= wi.z < 0 ? through : all<N>(1);
  }
}

template <int N, class Parts>
Evaluation<N> Bsdf<N, Parts>::evaluate(const V& wi, const V& h) const {
  Evaluation<N> e = base_.evaluate(wi, h);
  if (features_.is_spec && features_.layers != LayerSide::none) spec_absorb(wi, e.value);
  if (!has_layers_above()) return e;
  e.pdf *= 1 - coat_probability_ - sheen_probability_;
  add_sheen(wi, h, e);
  add_coat(wi, h, e);
  return e;
}

template <int N, class Parts>
auto Bsdf<N, Parts>::sample(const Floats2<N>& u, const F& lobe) const -> Sample {
  if (!has_layers_above()) {
    const typename Base::Direction direction = base_.sample(u, lobe);
    return {direction.wi, evaluate(direction.wi, direction.h)};
  }
  const F layers = coat_probability_ + sheen_probability_;
  const F rest = lobe < layers ? F{} : sampling::reused<N>(lobe, layers, 1 - layers);
  V wi = base_.sample(u, rest).wi;
  const auto is_coat = lobe < coat_probability_, is_sheen = lobe < layers;
  wi = select3(is_sheen, coating_->sheen().direction(u), wi);
  if (any(is_coat)) {
    const Frame<N>& frame = coating_->coat_frame();
    const V o = frame.to_local(wo_), h = coating_->coat().visible_normal(o, u);
    const V i = (2 * dot(o, h)) * h - o, coated = frame.to_world(i);
    const auto is_above = (i.z > 0) & is_reached(coated);
    wi = select3(is_coat, select3(is_above, coated, all3<N>(0)), wi);
  }
  return {wi, evaluate(wi)};
}

}  // namespace microtrace::bsdf
