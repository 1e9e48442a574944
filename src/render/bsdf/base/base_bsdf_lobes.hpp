#pragma once
/// Evaluates and samples a BaseBsdf.

#include "render/bsdf/base/base_bsdf.hpp"

namespace microtrace::bsdf {

/// Mirrors a direction at the surface, for transmission.
template <class V>
V mirrored(const V& w) {
  return {w.x, w.y, -w.z};
}

template <int N, class Parts>
auto BaseBsdf<N, Parts>::reflectance(const Schlick<N>& schlick, const F& cosine) const -> V {
  if (!features_.has_film) return schlick(cosine);
  return mixed(schlick(cosine), thin_film_reflectance<N>(cosine, film_, schlick.f0), film_.share);
}

template <int N, class Parts>
auto BaseBsdf<N, Parts>::reflectance(const F& cosine) const -> V {
  if (!features_.has_film) return specular_(cosine);
  // With a film, reflectance is not linear in the reflectance below the film.
  if (!any(metallic_ > 0)) return reflectance(dielectric_, cosine);
  if (!any(metallic_ < 1)) return reflectance(metal_, cosine);
  return mixed(reflectance(dielectric_, cosine), reflectance(metal_, cosine), metallic_);
}

template <int N, class Parts>
auto BaseBsdf<N, Parts>::incidence(const F& cosine) const -> Incidence {
  if (!features_.refracts) return {cosine, F{}};
  const F square = 1 - (1 - cosine * cosine) / (eta_ * eta_);
  const auto from_denser = eta_<1, enters = square> 0;
  return {from_denser ? square_root<N>(enters ? square : F{}) : cosine,
          from_denser ? (enters ? F{} : all<N>(1)) : F{}};
}

template <int N, class Parts>
auto BaseBsdf<N, Parts>::shares(const F& angle_cosine) const -> Shares {
  if (features_.is_spec) return spec_shares(angle_cosine);
  if (!features_.transmits) return {reflectance(angle_cosine), all3<N>(0), F{}, F{}};
  const auto [cosine, is_total] = incidence(angle_cosine);
  const auto is_opaque = is_zero(transmitted_);
  const V dielectric = reflectance(dielectric_, cosine);
  const V entering = complement(dielectric) * transmitted_;
  V reflected = dielectric;
  const auto is_mixed = (metallic_ != 0) & negated(is_opaque);
  if (any(is_mixed)) {
    const V both = features_.has_film ? mixed(reflected, reflectance(metal_, cosine), metallic_)
                                      : specular_(cosine);
    reflected = select3(is_mixed, both, reflected);
  }
  if (any(is_opaque)) reflected = select3(is_opaque, reflectance(cosine), reflected);
  const V none = all3<N>(0);
  reflected = select3(is_total != 0, all3<N>(1), reflected);
  if (features_.refracts && any(bare_ > 0)) {
    const V covered = select3(is_total != 0, all3<N>(1), dielectric);
    reflected = greatest_components(V(reflected - bare_ * covered), none);
  }
  const V through = select3((is_total != 0) | is_opaque, none, entering);
  return {reflected, through, F{},
          is_coated_behind() ? F(1 - coating_below()->transmittance(cosine)) : F{}};
}

// fresnel_mix of KHR_materials_specular and rgb_mix of KHR_materials_iridescence, which equal the
// fresnel_mix of glTF 2.0, section B.3.5, if the reflectance is gray. Metal and dielectric are
// mixed as in section B.2.
template <int N, class Parts>
auto BaseBsdf<N, Parts>::spec_shares(const F& angle_cosine) const -> Shares {
  const auto [cosine, is_total] = incidence(angle_cosine);
  const V dielectric = select3(is_total != 0, all3<N>(1), reflectance(dielectric_, cosine));
  const F left = 1 - greatest_component(dielectric);
  return {mixed(dielectric, reflectance(metal_, cosine), metallic_),
          features_.transmits ? V(left * transmitted_) : all3<N>(0), left, F{}};
}

template <int N, class Parts>
auto BaseBsdf<N, Parts>::returned(const V& wi, const V& h) const -> F {
  const F cosine = smaller_of(dot(wo_, h), all<N>(1));
  const F along = larger_of(F(1 - (1 - cosine * cosine) / (eta_ * eta_)), F{});
  const F toward = (square_root<N>(along) - cosine / eta_) * h.z;
  const F z_o = toward + wo_.z / eta_, z_i = toward + wi.z / eta_;
  const auto transmittance = [&](const F& z) {
    return coating_below()->transmittance(smaller_of(z, all<N>(1)));
  };
  const F through = larger_of(transmittance(z_o), transmittance(z_i));
  const F here = 2 / (wo_.z + ggx_.root(wo_)), there = 2 / (wi.z + ggx_.root(wi));
  const F visibility = 0.25F * smaller_of(F(here / wi.z), F(there / wo_.z));
  return ((z_o > 0) & (z_i > 0)) ? visibility * (1 - through) : F{};
}

template <int N, class Parts>
auto BaseBsdf<N, Parts>::reflection_probability(const Shares& shares) const -> F {
  const F entering = luminance(shares.entering), through = entering * (1 - shares.returned);
  const F reflected = luminance(shares.reflected) + entering * shares.returned;
  const F sum = reflected + through;
  const auto is_shared = (sum > 0) & negated(is_zero(transmitted_));
  return is_shared ? reflected / sum : all<N>(1);
}

template <int N, class Parts>
Evaluation<N> BaseBsdf<N, Parts>::above(const V& wi, const V& h) const {
  const F d = ggx_.distribution(h);
  const Shares facet = shares(smaller_of(dot(wo_, h), all<N>(1)));
  const Left there = left(coating_above(), wi, facet);
  V single = facet.reflected * (d * visibility(wi));
  const F transmittance = this->transmittance(coating_above(), wi);
  single *= transmittance;
  V f = single + diffuse_ * there.diffuse + multiple_ * there.f1;
  F facets = facet_probability_, rest = 1 - facet_probability_;
  if (is_coated_behind()) f += facet.entering * (d * returned(wi, h));
  if (features_.refracts) {
    const V bare = bare_diffuse_ + bare_kept_ * (1 - bare_through_ * there.diffuse);
    f += lost_ * (loss_.above(wi.z) * transmittance) + bare;
  }
  if (features_.transmits) {
    facets *= reflection_probability(facet);
    rest *= 1 - below_probability_;
  }
  return {f * wi.z, facets * ggx_.reflected_pdf(wo_, d) + rest * kInversePi * wi.z};
}

template <int N, class Parts>
Evaluation<N> BaseBsdf<N, Parts>::below(const V& wi, const V& h) const {
  const V up = mirrored(wi);
  Shares facet{all3<N>(0), all3<N>(0), F{}, F{}};
  if (features_.is_spec || !features_.refracts) facet = shares(smaller_of(dot(wo_, h), all<N>(1)));
  const Left there = left(coating_below(), up, facet);
  const F transmittance = this->transmittance(coating_below(), up);
  V spread = diffuse_below_ * there.diffuse + multiple_below_ * there.f1;
  if (features_.refracts) spread += lost_below_ * (loss_.below(up.z) * transmittance);
  Evaluation<N> e{spread * up.z, (1 - facet_probability_) * below_probability_ * kInversePi * up.z};
  if (features_.refracts) {
    refract(wi, transmittance, e);
    return e;
  }
  const F d = ggx_.distribution(h);
  const F single = d * visibility(up) * up.z * transmittance;
  const auto is_opaque = is_zero(transmitted_);
  const F pdf =
      facet_probability_ * (1 - reflection_probability(facet)) * ggx_.reflected_pdf(wo_, d);
  return {select3(is_opaque, e.value, V(e.value + facet.entering * single)),
          is_opaque ? e.pdf : e.pdf + pdf};
}

template <int N, class Parts>
void BaseBsdf<N, Parts>::refract(const V& wi, const F& transmittance, Evaluation<N>& e) const {
  const V sum = wo_ + eta_ * wi;
  const F square = dot(sum, sum);
  V h = unit<N>(sum);
  h = select3(h.z < 0, V(-h), h);
  const F cos_o = dot(wo_, h), cos_i = dot(wi, h);
  const F denominator = cos_o + eta_ * cos_i;
  const Shares facet = shares(smaller_of(cos_o, all<N>(1)));
  // `spreading` is the Jacobian of the map from microfacet normals to directions. `here` and
  // `there` are G1 / z = 2 / (z + root) for wo and wi.
  const F spreading = eta_ * eta_ * -cos_i / (denominator * denominator);
  const F here = 2 / (wo_.z + ggx_.root(wo_)), there = 2 / (-wi.z + ggx_.root(wi));
  const F seen = ggx_.distribution(h) * cos_o * here * spreading;
  // The masking term is the smaller G1 of the two directions, which makes a boundary between equal
  // indices of refraction invisible, or the specification's product of both.
  const F unmasked =
      features_.is_spec ? there * -wi.z : smaller_of(all<N>(1), F(there * -wi.z / (here * wo_.z)));
  const auto refracts =
      (square > 0) & (cos_o > 0) & (cos_i < 0) & (seen < 1e30F) & negated(is_zero(transmitted_));
  const F pdf = facet_probability_ * (1 - reflection_probability(facet)) * seen;
  e.value =
      select3(refracts, V(e.value + facet.entering * (seen * unmasked * transmittance)), e.value);
  e.pdf = refracts ? e.pdf + pdf : e.pdf;
}

template <int N, class Parts>
Evaluation<N> BaseBsdf<N, Parts>::evaluate(const V& wi, const V& h) const {
  const auto is_above = wi.z > 0, is_below = wi.z < 0;
  Evaluation<N> e{all3<N>(0), F{}};
  if (any(is_above)) {
    const Evaluation<N> up = above(wi, h);
    e = {select3(is_above, up.value, e.value), is_above ? up.pdf : e.pdf};
  }
  if (features_.transmits && any(is_below)) {
    const Evaluation<N> down = below(wi, h);
    e = {select3(is_below, down.value, e.value), is_below ? down.pdf : e.pdf};
  }
  return e;
}

template <int N, class Parts>
auto BaseBsdf<N, Parts>::sample(const Floats2<N>& u, const F& lobe) const -> Direction {
  const V h = ggx_.visible_normal(wo_, u);
  const F cosine = smaller_of(dot(wo_, h), all<N>(1));
  const V mirror = (2 * cosine) * h - wo_, spread = sampling::cosine_hemisphere<N>(u);
  const auto is_facet = lobe < facet_probability_;
  const V none = all3<N>(0);
  const V reflected = select3(mirror.z > 0, mirror, none);
  if (!features_.transmits) {
    const V wi = select3(is_facet, reflected, spread);
    return {wi, kIsPlain ? select3(is_facet, h, half_vector(spread)) : half_vector(wi)};
  }
  V through = select3(mirror.z > 0, mirrored(mirror), none);
  if (features_.refracts) {
    // Under total reflection, there is no transmitted sample.
    const F along = 1 - (1 - cosine * cosine) / (eta_ * eta_);
    const V refracted = (cosine / eta_ - square_root<N>(larger_of(along, F{}))) * h - wo_ / eta_;
    through = select3(refracted.z < 0, refracted, none);
  }
  const auto is_reflected = lobe < facet_probability_ * reflection_probability(shares(cosine));
  const auto is_below = lobe - facet_probability_ < (1 - facet_probability_) * below_probability_;
  const V wi = select3(is_facet, select3(is_reflected, reflected, through),
                       select3(is_below, mirrored(spread), spread));
  return {wi, half_vector(wi)};
}

}  // namespace microtrace::bsdf
