#include "render/bsdf/general.hpp"

#include "render/bsdf/frame.hpp"
#include "render/bsdf/multiple_scattering.hpp"
#include "render/bsdf/thin_film.hpp"
#include "render/luminance.hpp"
#include "render/sampling/warps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace::bsdf {
namespace {

/// The direction mirrored at the surface, for transmission.
Vec3 mirrored(const Vec3& w) {
  return {w.x, w.y, -w.z};
}

/// Indices closer to 1 than this are not refracted.
float usable_eta(float eta) {
  constexpr float least = 0.003F;
  if (std::abs(eta - 1) >= least) return eta;
  return eta < 1 ? 1 - least : 1 + least;
}

template <typename Microfacets>
Microfacets microfacets(const Parameters& p) {
  if constexpr (std::is_same_v<Microfacets, Ggx>) {
    return Ggx(p.roughness);
  } else {
    return AnisotropicGgx(p.roughness, p.anisotropy, p.along);
  }
}

}  // namespace

template <typename Microfacets>
GeneralBsdf<Microfacets>::GeneralBsdf(const Parameters& p, const Coating* coating, const Vec3& wo)
    : wo_(wo),
      ggx_(microfacets<Microfacets>(p)),
      albedo_(ggx_),
      dielectric_(p.dielectric),
      metal_{.f0 = p.base_color},
      specular_{.f0 = p.dielectric.f0 + p.metallic * (p.base_color - p.dielectric.f0),
                .f90 = p.dielectric.f90 + p.metallic * (1 - p.dielectric.f90)},
      film_(p.film),
      metallic_(p.metallic),
      greatest_{.f0 = std::max({p.dielectric.f0.x, p.dielectric.f0.y, p.dielectric.f0.z}),
                .f90 = p.dielectric.f90},
      transmittance_(coating != nullptr ? coating->transmittance(wo) : 1) {
  if (p.eta) eta_ = usable_eta(*p.eta);
  const Vec3 f0 = film_ ? add_film(specular_) : specular_.f0;
  const Albedo white_mean = albedo_.mean(), there = albedo_.at(wo);
  multiply_reflected_ = multiple_scattering(greatest_.f0, greatest_.f90, white_mean.f1);
  const Left mean = mean_left(coating), here = left(coating, wo);
  const Vec3 returned = multiple_scattering(f0, specular_.f90, white_mean.f1);
  const float several = kInversePi / std::max(mean.f1, 1e-6F) * here.f1;
  // Refracted light has its own energy compensation.
  multiple_ = returned * several * (eta_ ? 1 - (1 - p.metallic) * p.transmission : 1);
  const float mean_diffuse = std::max(mean.diffuse, 1e-6F), dielectric = 1 - p.metallic;
  // From inside, the diffuse part is not visible.
  const float opaque = eta_ && *eta_ < 1 ? 0 : 1 - p.transmission;
  const Vec3 diffuse(dielectric * opaque * kInversePi * here.diffuse / mean_diffuse);
  diffuse_ = (1 - p.diffuse_transmission) * diffuse * p.base_color;
  diffuse_below_ = p.diffuse_transmission * diffuse * p.diffuse_transmission_color;
  // The base color of a volume counts once for entering and leaving together, as in renderers
  // without walls.
  transmitted_ = dielectric * p.transmission * (eta_ ? glm::sqrt(p.base_color) : p.base_color);
  multiple_below_ = Vec3(0);
  if (!eta_) {
    const Vec3 kept = metallic_ > 0
                          ? multiple_scattering(dielectric_.f0, dielectric_.f90, white_mean.f1)
                          : returned;
    multiple_below_ = glm::min((Vec3(1) - kept) * transmitted_, Vec3(1) - returned) * several;
  } else if (transmitted_ != Vec3(0)) {
    add_refraction_loss(p);
  }

  // In proportion to each lobe's approximate albedo, with a minimum probability unless the lobe is
  // negligible.
  const float reflected =
      luminance(f0 * (there.f1 - there.schlick)) + specular_.f90 * there.schlick;
  const float facets = reflected + luminance(transmitted_) * here.diffuse;
  const float up = (luminance(diffuse_) * mean_diffuse + luminance(multiple_) * mean.f1 +
                    luminance(lost_) * loss_.mean_above()) /
                   kInversePi;
  const float down =
      (luminance(diffuse_below_) * mean_diffuse + luminance(multiple_below_) * mean.f1 +
       luminance(lost_below_) * loss_.mean_below()) /
      kInversePi;
  const float spread = up + down;
  facet_probability_ = spread > 0.002F ? std::clamp(facets / (facets + spread), 0.1F, 0.9F) : 1;
  below_probability_ = down > 0 ? std::clamp(down / spread, 0.1F, 0.9F) : 0;
}

template <typename Microfacets>
void GeneralBsdf<Microfacets>::add_refraction_loss(const Parameters& p) {
  // There are no tables for films and anisotropic facets.
  if (film_ || !std::is_same_v<Microfacets, Ggx>) return;
  loss_ = RefractionLoss(p.roughness, *eta_, greatest_);
  const float through = loss_.through(), here = loss_.above(wo_.z) * kInversePi;
  const float entering = (1 - p.metallic) * p.transmission;
  // Light that never enters keeps its color.
  const Vec3 reflected = Vec3(entering * multiply_reflected_) +
                         transmitted_ * std::max(1 - through - multiply_reflected_, 0.0F);
  lost_ = reflected * (here / loss_.mean_above());
  lost_below_ = transmitted_ * (through * here / loss_.mean_below());
}

template <typename Microfacets>
Vec3 GeneralBsdf<Microfacets>::add_film(const Schlick& schlick) {
  // The film's reflectance oscillates with the angle. The base gets the energy left at the
  // brightest of these angles, with a margin for the angles between.
  constexpr std::array cosines{1.0F, 0.8F, 0.6F, 0.42F, 0.28F, 0.17F, 0.09F, 0.03F};
  constexpr std::size_t of_mean = 4;
  constexpr float margin = 0.05F;
  Vec3 mean(0);
  float bound = greatest_.f0;
  for (std::size_t k = 0; k < (metallic_ < 1 ? cosines.size() : of_mean); ++k) {
    const float edge = Schlick{.f0 = Vec3(0)}(cosines[k]).x;
    const Vec3 f = thin_film_reflectance(cosines[k], film_->ior, film_->thickness, schlick.f0);
    const Vec3 head_on = glm::max((f - Vec3(edge)) / (1 - edge), Vec3(0));
    if (k < of_mean) mean += head_on * (1.0F / of_mean);
    bound = std::max(bound, std::max({head_on.x, head_on.y, head_on.z}) + margin);
  }
  greatest_.f0 += film_->share * (std::min(bound, 1.0F) - greatest_.f0);
  greatest_.f90 += film_->share * (1 - greatest_.f90);
  return glm::mix(schlick.f0, mean, film_->share);
}

template <typename Microfacets>
auto GeneralBsdf<Microfacets>::left(const Albedo& albedo, float transmittance,
                                    const Albedo& deficit) const -> Left {
  const float diffuse = 1 - greatest_.albedo(albedo) - multiply_reflected_ * (1 - albedo.f1);
  return {.f1 = transmittance * (1 - albedo.f1) + deficit.f1,
          .diffuse = std::max(transmittance * diffuse +
                                  (greatest_.albedo(deficit) - multiply_reflected_ * deficit.f1),
                              0.0F)};
}

template <typename Microfacets>
auto GeneralBsdf<Microfacets>::left(const Coating* coating, const Vec3& w) const -> Left {
  const Albedo albedo = albedo_.at(w);
  if (coating == nullptr) return left(albedo, 1, {});
  return left(albedo, coating->transmittance(w), coating->deficit(w.z));
}

template <typename Microfacets>
auto GeneralBsdf<Microfacets>::mean_left(const Coating* coating) const -> Left {
  if (coating == nullptr) return left(albedo_.mean(), 1, {});
  Left sum{};
  for (std::size_t k = 0; k < kCoatingNodes; ++k) {
    const float z = kCoatingNode[k];
    const Left part =
        left(albedo_.around(z), coating->transmittance_at_node(k), coating->deficit(z));
    sum.f1 += kCoatingWeight[k] * part.f1;
    sum.diffuse += kCoatingWeight[k] * part.diffuse;
  }
  return sum;
}

// Schlick's term uses the angle in the thinner medium.
template <typename Microfacets>
Vec3 GeneralBsdf<Microfacets>::reflectance(const Schlick& schlick, float cosine) const {
  if (!film_) return schlick(cosine);
  return glm::mix(schlick(cosine),
                  thin_film_reflectance(cosine, film_->ior, film_->thickness, schlick.f0),
                  film_->share);
}

template <typename Microfacets>
auto GeneralBsdf<Microfacets>::shares(float cosine) const -> Shares {
  if (eta_ && *eta_ < 1) {
    const float square = 1 - (1 - cosine * cosine) / (*eta_ * *eta_);
    if (!(square > 0)) return {.reflected = Vec3(1), .entering = Vec3(0)};
    cosine = std::sqrt(square);
  }
  if (transmitted_ == Vec3(0))
    return {.reflected = reflectance(specular_, cosine), .entering = Vec3(0)};
  const Vec3 kept = reflectance(dielectric_, cosine);
  // Below a film, the reflectances of metal and dielectric do not follow from those without film.
  const Vec3 reflected = metallic_ == 0 ? kept
                         : film_        ? glm::mix(kept, reflectance(metal_, cosine), metallic_)
                                        : specular_(cosine);
  return {.reflected = reflected, .entering = (Vec3(1) - kept) * transmitted_};
}

template <typename Microfacets>
float GeneralBsdf<Microfacets>::reflection_probability(const Shares& shares) const {
  if (transmitted_ == Vec3(0)) return 1;
  const float reflected = luminance(shares.reflected), through = luminance(shares.entering);
  return reflected + through > 0 ? reflected / (reflected + through) : 1;
}

template <typename Microfacets>
Evaluation GeneralBsdf<Microfacets>::above(const Coating* coating, const Vec3& wi) const {
  const Vec3 h = unit(wo_ + wi);
  const float d = ggx_.distribution(h);
  const Shares facet = shares(std::min(glm::dot(wo_, h), 1.0F));
  const float transmittance =
      coating != nullptr ? std::min(transmittance_, coating->transmittance(wi)) : 1;
  const Left there = left(coating, wi);
  const Vec3 f = facet.reflected * (d * ggx_.visibility(wo_, wi)) * transmittance +
                 diffuse_ * there.diffuse + multiple_ * there.f1 + lost_ * loss_.above(wi.z);
  return {.value = f * wi.z,
          .pdf = facet_probability_ * reflection_probability(facet) * ggx_.reflected_pdf(wo_, d) +
                 (1 - facet_probability_) * (1 - below_probability_) * kInversePi * wi.z};
}

template <typename Microfacets>
Evaluation GeneralBsdf<Microfacets>::below(const Coating* coating, const Vec3& wi) const {
  const Vec3 up = mirrored(wi);
  const Left there = left(coating, up);
  const Vec3 spread =
      diffuse_below_ * there.diffuse + multiple_below_ * there.f1 + lost_below_ * loss_.below(up.z);
  Evaluation e{.value = spread * up.z,
               .pdf = (1 - facet_probability_) * below_probability_ * kInversePi * up.z};
  if (transmitted_ == Vec3(0)) return e;
  if (eta_) {
    refract(wi, e);
    return e;
  }
  const Vec3 h = unit(wo_ + up);
  const float d = ggx_.distribution(h);
  const Shares facet = shares(std::min(glm::dot(wo_, h), 1.0F));
  const float transmittance =
      coating != nullptr ? std::min(transmittance_, coating->transmittance(up)) : 1;
  e.value += facet.entering * (d * ggx_.visibility(wo_, up) * up.z * transmittance);
  e.pdf += facet_probability_ * (1 - reflection_probability(facet)) * ggx_.reflected_pdf(wo_, d);
  return e;
}

template <typename Microfacets>
void GeneralBsdf<Microfacets>::refract(const Vec3& wi, Evaluation& e) const {
  const Vec3 sum = wo_ + *eta_ * wi;
  const float square = glm::dot(sum, sum);
  if (!(square > 0)) return;
  Vec3 h = sum / std::sqrt(square);
  if (h.z < 0) h = -h;
  const float cos_o = glm::dot(wo_, h), cos_i = glm::dot(wi, h);
  if (!(cos_o > 0) || !(cos_i < 0)) return;
  const float denominator = cos_o + *eta_ * cos_i;
  const Shares facet = shares(std::min(cos_o, 1.0F));
  // The Jacobian from microfacet normals to directions; and the facets visible from each direction,
  // 2 / (z + root) = G1 / z.
  const float spreading = *eta_ * *eta_ * -cos_i / (denominator * denominator);
  const float here = 2 / (wo_.z + ggx_.root(wo_)), there = 2 / (-wi.z + ggx_.root(wi));
  const float seen = ggx_.distribution(h) * cos_o * here * spreading;
  // A facet visible from one side is masked only if fewer are visible from the other side, so a
  // boundary of equal indices is invisible.
  const float unmasked = std::min(1.0F, there * -wi.z / (here * wo_.z));
  if (!(seen < 1e30F)) return;
  e.value += facet.entering * (seen * unmasked);
  e.pdf += facet_probability_ * (1 - reflection_probability(facet)) * seen;
}

template <typename Microfacets>
Evaluation GeneralBsdf<Microfacets>::evaluate(const Coating* coating, const Vec3& wi) const {
  if (wi.z > 0) return above(coating, wi);
  return wi.z < 0 ? below(coating, wi) : Evaluation{};
}

template <typename Microfacets>
Vec3 GeneralBsdf<Microfacets>::direction(const Vec2& u, float lobe) const {
  if (lobe < facet_probability_) {
    const Vec3 h = ggx_.visible_normal(wo_, u);
    const float cosine = std::min(glm::dot(wo_, h), 1.0F);
    const Vec3 reflected = 2 * cosine * h - wo_;
    if (lobe < facet_probability_ * reflection_probability(shares(cosine)))
      return reflected.z > 0 ? reflected : Vec3(0);
    if (!eta_) return reflected.z > 0 ? mirrored(reflected) : Vec3(0);
    // Total reflection has no transmitted sample.
    const float along = 1 - (1 - cosine * cosine) / (*eta_ * *eta_);
    const Vec3 through = (cosine / *eta_ - std::sqrt(std::max(along, 0.0F))) * h - wo_ / *eta_;
    return through.z < 0 ? through : Vec3(0);
  }
  const Vec3 wi = sampling::cosine_hemisphere(u);
  return lobe - facet_probability_ < (1 - facet_probability_) * below_probability_ ? mirrored(wi)
                                                                                   : wi;
}

template class GeneralBsdf<Ggx>;
template class GeneralBsdf<AnisotropicGgx>;

}  // namespace microtrace::bsdf
