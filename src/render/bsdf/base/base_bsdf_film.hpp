#pragma once
/// Computes the parts of a BaseBsdf that describe the dielectric under a thin film.

#include "render/bsdf/base/base_bsdf.hpp"

namespace microtrace::bsdf {

template <int N, class Parts>
auto BaseBsdf<N, Parts>::add_film(const F& roughness, HeadOn& parts) -> V {
  const F alpha = roughness * roughness;
  const F least = 2.6F * alpha / (1 + 1.25F * alpha);
  least_square_ = least * least;
  on_facets_ = (1 - 0.23F * alpha / (1 + 1.2F * alpha)) / square_root<N>(1 + least_square_);
  constexpr int kFirstOfMean = 3;
  constexpr float kWeight = 1.0F / (kFilmNodes - kFirstOfMean);
  constexpr auto of_mean = hat_weights<1, kFilmNodes>();
  // Film and Schlick's term reach 1 at grazing angles, so the first node is slightly above.
  constexpr float kLeastCosine = 0.03F;
  const bool has_metal = any(metallic_ > 0), has_dielectric = any(metallic_ < 1);
  const F without = greatest_.f0, least_without = least_component(dielectric_.f0);
  V dielectric = all3<N>(0), metal = all3<N>(0);
  greatest_.f0 = film_mean_least_ = F{};
  for (int k = 0; k < kFilmNodes; ++k) {
    const F cosine = all<N>(k == 0 ? kLeastCosine : static_cast<float>(k) / (kFilmNodes - 1));
    const F edge = Schlick<N>::edge(cosine);
    const auto f0_with_film = [&](const Schlick<N>& below) {
      const V f = thin_film_reflectance<N>(cosine, film_, below.f0);
      return V((f - edge) / (1 - edge));
    };
    // At grazing angles, a film may reflect less than Schlick's term.
    const auto positive = [](const V& f0) { return greatest_components(f0, all3<N>(0)); };
    film_f0_[k] = without;
    film_least_[k] = least_without;
    if (has_dielectric) {
      const V exactly = f0_with_film(dielectric_), f0 = positive(exactly);
      if (k >= kFirstOfMean) dielectric += kWeight * f0;
      film_least_[k] += film_.share * (least_component(exactly) - least_without);
      film_f0_[k] += film_.share * (greatest_component(f0) - without);
    }
    greatest_.f0 += of_mean.value[k] * film_f0_[k];
    film_mean_least_ += of_mean.value[k] * film_least_[k];
    if (has_metal && k >= kFirstOfMean) metal += kWeight * positive(f0_with_film(metal_));
  }
  greatest_.f90 += film_.share * (1 - greatest_.f90);
  const V both =
      select3(metallic_ > 0, select3(metallic_ < 1, mixed(dielectric, metal, metallic_), metal),
              dielectric);
  parts = {mixed(dielectric_.f0, dielectric, film_.share), mixed(metal_.f0, metal, film_.share)};
  return mixed(specular_.f0, both, film_.share);
}

template <int N, class Parts>
auto BaseBsdf<N, Parts>::dielectric_at(const F& z) const -> GreatestSchlick<N> {
  if (!features_.has_film) return greatest_;
  return {film_f0_at(film_f0_, z), greatest_.f90};
}

template <int N, class Parts>
auto BaseBsdf<N, Parts>::film_f0_at(const F (&f0)[kFilmNodes], const F& z) const -> F {
  // The mean cosine of the angle of incidence on the facets that reflect light from this direction,
  // fitted to sampled GGX facets with an error of at most 0.04.
  const F cosine = on_facets_ * square_root<N>(z * z + least_square_);
  const Cell<N> cell(cosine * (kFilmNodes - 1), kFilmNodes);
  return cell.mixed(picked<N>(f0, cell.first), picked<N>(f0 + 1, cell.first));
}

template <int N, class Parts>
auto BaseBsdf<N, Parts>::film_f0_range(const F& cosine) const ->
    typename RefractionLoss<N>::F0Range {
  // Facets are also seen at other angles than the mean one.
  return {smaller_of(film_f0_at(film_least_, cosine), film_mean_least_),
          larger_of(film_f0_at(film_f0_, cosine), greatest_.f0)};
}

}  // namespace microtrace::bsdf
