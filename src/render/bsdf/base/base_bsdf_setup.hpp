#pragma once
/// Computes the parts of a BaseBsdf that depend only on wo.

#include "render/bsdf/base/base_bsdf_film.hpp"

namespace microtrace::bsdf {

template <int N, class Parts>
BaseBsdf<N, Parts>::BaseBsdf(const FeaturesType& features, const Surface<N>& p,
                             const Microfacets& microfacets, const Coatings<N>& coatings,
                             const V& wo)
    : features_(features),
      wo_(wo),
      ggx_(microfacets),
      albedo_(ggx_),
      specular_{p.dielectric.f0 + p.metallic * (p.base_color - p.dielectric.f0),
                p.dielectric.f90 + p.metallic * (1 - p.dielectric.f90)},
      greatest_{greatest_component(p.dielectric.f0), p.dielectric.f90},
      coatings_(coatings) {
  const F least = all<N>(1e-6F), dielectric = 1 - p.metallic;
  const Coating<N>* coating = coating_above();
  transmittance_ = coating == nullptr ? all<N>(1) : coating->transmittance(wo);
  V f0 = specular_.f0;
  HeadOn parts{p.dielectric.f0, p.base_color};
  if (features_.transmits || features_.has_film || features_.is_spec) {
    metallic_ = p.metallic;
    dielectric_ = p.dielectric;
    metal_ = {p.base_color, all<N>(1)};
  }
  if (features_.has_film) {
    film_ = p.film;
    f0 = add_film(p.roughness, parts);
  }
  const Albedo<N> white_mean = albedo_.mean(), there = albedo_.at(wo);
  multiply_reflected_ = multiple_scattering(greatest_.f0, greatest_.f90, white_mean.f1);
  // The specification's factors of the diffuse part depend on the half vector.
  Left mean{.f1 = F{}, .diffuse = all<N>(1)}, here = mean;
  if (!features_.is_spec) mean = mean_left(coating), here = left(coating, wo);
  const F several = kInversePi / larger_of(mean.f1, least) * here.f1;
  multiple_ = multiply_scattered(p, f0, parts, white_mean.f1) * several;
  // By reciprocity, diffuse transmission is divided by the mean of the side without layers.
  F mean_below = mean.diffuse;
  if (features_.refracts && coatings_.above != coatings_.below)
    mean_below = mean_left(coating_below()).diffuse;
  const F mean_diffuse = larger_of(mean.diffuse, least);
  const F opaque = features_.transmits ? 1 - p.transmission : all<N>(1);
  const F diffuse = dielectric * opaque * kInversePi * here.diffuse / mean_diffuse;
  diffuse_ = diffuse * p.base_color;
  if (features_.transmits) {
    diffuse_ = ((1 - p.diffuse_transmission) * diffuse) * p.base_color;
    const F through = p.diffuse_transmission * diffuse;
    diffuse_below_ =
        (through * smaller_of(all<N>(1), F(mean_diffuse / larger_of(mean_below, least)))) *
        p.diffuse_transmission_color;
    if (features_.refracts) uncover_opaque_part(p, here.diffuse, mean_diffuse, mean_below);
    add_transmission(p, f0, white_mean.f1, several);
  }

  // Samples lobes in proportion to their approximate albedos, with a minimum probability, since
  // directions that only the other lobe's tail finds would have enormous weights. The minimum
  // falls with the albedo of dark lobes. From inside of a body, paths may meet the surface hundreds
  // of times, and each time the minimum of a dark lobe gives the others a weight above 1.
  const F most_rare = all<N>(0.1F);
  const auto least_of = [&](const F& part) {
    return features_.refracts ? clamped(F(2 * part), all<N>(0.01F), most_rare) : most_rare;
  };
  F facets = luminance(f0 * (there.f1 - there.schlick)) + specular_.f90 * there.schlick;
  F spread = luminance(diffuse_) * mean_diffuse + luminance(multiple_) * mean.f1;
  if (features_.transmits) {
    if (features_.refracts) facets *= 1 - bare_;
    facets += luminance(transmitted_) * here.diffuse;
    F down = luminance(diffuse_below_) * mean_diffuse + luminance(multiple_below_) * mean.f1;
    if (features_.refracts) {
      spread += luminance(lost_) * loss_.mean_above() + luminance(bare_diffuse_ + bare_kept_);
      down += luminance(lost_below_) * loss_.mean_below();
    }
    spread /= kInversePi;
    down /= kInversePi;
    spread += down;
    const F part = down / spread, share = clamped(part, least_of(part), F(1 - least_of(1 - part)));
    below_probability_ = down > 0 ? share : F{};
  } else {
    spread /= kInversePi;
  }
  const F rarest =
      spread > (kIsPlain ? 0.01F : 0.002F) ? most_rare : smaller_of(F(10 * spread), all<N>(0.02F));
  const F part = facets / (facets + spread);
  const F least_facets = features_.refracts ? least_of(part) : all<N>(0.05F);
  const F share = clamped(part, least_facets, F(1 - rarest));
  auto is_matte = is_zero(f0) & (specular_.f90 == 0);
  if (features_.transmits) is_matte = is_matte & is_zero(transmitted_);
  facet_probability_ = is_matte ? F{} : spread > 0 ? share : all<N>(1);
}

template <int N, class Parts>
void BaseBsdf<N, Parts>::uncover_opaque_part(const Surface<N>& p, const F& here, const F& mean,
                                             const F& mean_below) {
  const F dielectric = 1 - p.metallic;
  const V none = all3<N>(0);
  const auto from_denser = p.eta < 1;
  diffuse_ = select3(from_denser, none, diffuse_);
  if (features_.is_spec) {
    // The specification has no formula for the opaque part as seen from inside.
    diffuse_below_ = select3(from_denser, none, diffuse_below_);
    bare_ = F{};
    bare_through_ = F{};
    bare_diffuse_ = bare_kept_ = none;
  } else {
    // By reciprocity, the denser side has this fraction of the diffuse transmission of the other.
    // The diffuse reflection gets the rest.
    bare_through_ = from_denser ? p.eta * p.eta : F{};
    diffuse_below_ = select3(from_denser, V(bare_through_ * diffuse_below_), diffuse_below_);
    bare_through_ *= smaller_of(all<N>(1), F(mean_below / mean));
    bare_ = from_denser ? dielectric * (1 - p.transmission) : F{};
    const F least = all<N>(1e-6F);
    const F kept = (1 - bare_through_ * here) / larger_of(F(1 - bare_through_ * mean), least);
    bare_kept_ =
        (bare_ * kInversePi * p.diffuse_transmission * kept) * p.diffuse_transmission_color;
    bare_diffuse_ = (bare_ * kInversePi * (1 - p.diffuse_transmission)) * p.base_color;
  }
}

template <int N, class Parts>
auto BaseBsdf<N, Parts>::multiply_scattered(const Surface<N>& p, const V& f0, const HeadOn& parts,
                                            const F& white_mean) const -> V {
  const F dielectric = 1 - p.metallic;
  F covered = all<N>(1);  // fraction of the dielectric that is compensated here
  V pure = multiple_scattering(f0, specular_.f90, white_mean);
  if (features_.refracts) {
    // Refracted light has its own energy compensation, and the bare part reflects all light.
    covered = p.eta < 1 ? F{} : 1 - p.transmission;
    pure *= p.metallic + dielectric * covered;
  }
  const auto is_mixed = (p.metallic > 0) & (p.metallic < 1);
  if (!any(is_mixed)) return pure;
  const V of_metal = multiple_scattering(parts.metal, all<N>(1), white_mean);
  const V of_dielectric = multiple_scattering(parts.dielectric, p.dielectric.f90, white_mean);
  return select3(is_mixed, V(p.metallic * of_metal + (dielectric * covered) * of_dielectric), pure);
}

template <int N, class Parts>
void BaseBsdf<N, Parts>::add_transmission(const Surface<N>& p, const V& f0, const F& white_mean,
                                          const F& several) {
  const F dielectric = 1 - p.metallic;
  if (!features_.refracts) {
    transmitted_ = (dielectric * p.transmission) * p.base_color;
    const V returned = multiple_scattering(f0, specular_.f90, white_mean);
    const V kept = select3(
        p.metallic > 0, multiple_scattering(dielectric_.f0, dielectric_.f90, white_mean), returned);
    multiple_below_ =
        least_components(V(complement(kept) * transmitted_), complement(returned)) * several;
    return;
  }
  // Relative indices of refraction must differ from 1 by at least this much.
  constexpr float kLeast = 0.003F;
  const auto is_usable = magnitude(F(p.eta - 1)) >= kLeast;
  eta_ = is_usable ? p.eta : p.eta < 1 ? all<N>(1 - kLeast) : all<N>(1 + kLeast);
  // Uses the square root of the base color, so that entering and leaving a volume together multiply
  // light by the base color once.
  const V root{square_root<N>(p.base_color.x), square_root<N>(p.base_color.y),
               square_root<N>(p.base_color.z)};
  // The specification multiplies by the base color at each boundary.
  transmitted_ = (dielectric * p.transmission) * (features_.is_spec ? p.base_color : root);
  multiple_below_ = lost_ = lost_below_ = all3<N>(0);
  if (!features_.is_spec) add_refraction_loss(p);
}

template <int N, class Parts>
void BaseBsdf<N, Parts>::add_refraction_loss(const Surface<N>& p) {
  using F0Range = typename RefractionLoss<N>::F0Range;
  const F0Range plain{least_component(p.dielectric.f0), greatest_component(p.dielectric.f0)};
  loss_ = RefractionLoss<N>(
      {.roughness = p.roughness,
       .eta = eta_,
       .dielectric = greatest_,
       .anisotropy = features_.is_anisotropic ? p.anisotropy : F{},
       .has_film = features_.has_film},
      [&](const F& cosine) { return features_.has_film ? film_f0_range(cosine) : plain; });
  const F through = loss_.through(), here = loss_.above(wo_.z) * kInversePi;
  const F entering = (1 - p.metallic) * p.transmission;
  // Light that never enters the volume is not tinted by the base color.
  const F inside = larger_of(F(1 - through - multiply_reflected_), F{});
  const V reflected = entering * multiply_reflected_ + transmitted_ * inside;
  const auto is_opaque = is_zero(transmitted_);
  lost_ = select3(is_opaque, lost_, V(reflected * (here / loss_.mean_above())));
  lost_below_ =
      select3(is_opaque, lost_below_, V(transmitted_ * (through * here / loss_.mean_below())));
  if (!is_coated_behind()) return;
  F returned{};
  for (int k = 0; k < static_cast<int>(kCoatingNodes); ++k) {
    returned += kTables.coating_weight[k] * loss_.below(all<N>(kTables.coating_node[k])) *
                (1 - coating_below()->transmittance_at_node(k));
  }
  lost_ += (returned / loss_.mean_above()) * lost_below_;
}

template <int N, class Parts>
auto BaseBsdf<N, Parts>::left(const GreatestSchlick<N>& dielectric, const Albedo<N>& albedo) const
    -> Left {
  return {1 - albedo.f1, larger_of(unreflected(dielectric, albedo), F{})};
}

template <int N, class Parts>
auto BaseBsdf<N, Parts>::left(const GreatestSchlick<N>& dielectric, const Albedo<N>& albedo,
                              const F& transmittance, const Albedo<N>& deficit) const -> Left {
  const F returned = dielectric.albedo(deficit) - multiply_reflected_ * deficit.f1;
  return {transmittance * (1 - albedo.f1) + deficit.f1,
          larger_of(F(transmittance * unreflected(dielectric, albedo) + returned), F{})};
}

template <int N, class Parts>
auto BaseBsdf<N, Parts>::left(const Coating<N>* coating, const V& w) const -> Left {
  const Albedo<N> albedo = albedo_.at(w);
  const GreatestSchlick<N> dielectric = dielectric_at(w.z);
  if (coating == nullptr) return left(dielectric, albedo);
  const F transmittance = coating->transmittance(w);
  return left(dielectric, albedo, transmittance, coating->deficit(w, transmittance, albedo));
}

template <int N, class Parts>
auto BaseBsdf<N, Parts>::mean_left(const Coating<N>* coating) const -> Left {
  if (coating == nullptr && !features_.has_film) return left(greatest_, albedo_.mean());
  Left sum{};
  for (int k = 0; k < static_cast<int>(kCoatingNodes); ++k) {
    const F z = all<N>(kTables.coating_node[k]);
    const GreatestSchlick<N> dielectric = dielectric_at(z);
    const Albedo<N> albedo = albedo_.around(z);
    const Left part = coating == nullptr
                          ? left(dielectric, albedo)
                          : left(dielectric, albedo, coating->transmittance_at_node(k),
                                 coating->deficit_at_node(k, albedo));
    sum.f1 += kTables.coating_weight[k] * part.f1;
    sum.diffuse += kTables.coating_weight[k] * part.diffuse;
  }
  return sum;
}

}  // namespace microtrace::bsdf
