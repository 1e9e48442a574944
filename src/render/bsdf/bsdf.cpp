#include "render/bsdf/bsdf.hpp"

#include "render/bsdf/frame.hpp"
#include "render/bsdf/glass_albedo.hpp"
#include "render/bsdf/thin_film.hpp"
#include "render/luminance.hpp"
#include "render/sampling/warps.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace::bsdf {
namespace {

/// Of light that single reflections do not return, the share that several do; `mean` is the white
/// albedo's (Kulla and Conty).
template <typename Color>
Color returned_later(const Color& f0, float f90, float mean) {
  const Color fresnel = f0 + (Color(f90) - f0) * (1 / 21.0F);
  return fresnel * fresnel * mean / (Color(1) - fresnel * (1 - mean));
}

/// Below the surface light goes on in the reflected direction's mirror image.
Vec3 mirrored(const Vec3& w) {
  return {w.x, w.y, -w.z};
}

/// Facets without direction that return about as much.
Ggx mean_facets(const Parameters& p) {
  if (p.anisotropy == 0) return Ggx(p.roughness);
  return Ggx(AnisotropicGgx(p.roughness, p.anisotropy, p.along).mean_roughness());
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
BasicBsdf<Microfacets>::BasicBsdf(const Parameters& p, const Vec3& wo)
    : wo_(wo),
      ggx_(microfacets<Microfacets>(p)),
      albedo_(mean_facets(p)),
      specular_{.f0 = p.dielectric.f0 + p.metallic * (p.base_color - p.dielectric.f0),
                .f90 = p.dielectric.f90 + p.metallic * (1 - p.dielectric.f90)},
      film_(p.film),
      greatest_{.f0 = std::max({p.dielectric.f0.x, p.dielectric.f0.y, p.dielectric.f0.z}),
                .f90 = p.dielectric.f90},
      eta_(p.eta) {
  const Vec3 f0 = film_ ? add_film() : specular_.f0;
  const Albedo mean = albedo_.mean(), there = albedo_.at(wo.z);
  returned_ = returned_later(greatest_.f0, greatest_.f90, mean.white);
  constexpr bool is_isotropic = std::is_same_v<Microfacets, Ggx>;
  multiple_ = returned_later(f0, specular_.f90, mean.white) *
              (kInversePi / std::max(1 - mean.white, 1e-6F) * (1 - there.white));
  if constexpr (!is_isotropic) multiple_ *= ggx_.evenness();
  const float dielectric = 1 - p.metallic, mean_left = std::max(left_over(mean), 1e-6F);
  float left = left_over(there);
  // From within a medium most light is reflected in all; the rest alone meets what is diffuse.
  if (eta_ && *eta_ < 1) left = std::min(left, 1 - luminance(fresnel(wo.z)));
  const Vec3 diffuse(dielectric * (1 - p.transmission) * kInversePi * left / mean_left);
  diffuse_ = (1 - p.diffuse_transmission) * diffuse * p.base_color;
  diffuse_below_ = p.diffuse_transmission * diffuse * p.diffuse_transmission_color;
  transmitted_ = dielectric * p.transmission * p.base_color;
  if (eta_) {
    // In and out together the base colour counts once, as in renderers that see no walls.
    transmitted_ = dielectric * p.transmission * glm::sqrt(p.base_color);
    // What several scatterings would return goes where one does: all light for wo is there, though
    // wi and wo are no equals then.
    const float glass = dielectric * p.transmission;
    const float gain = 1 / glass_albedo(*eta_, p.roughness, wo.z);
    transmitted_ *= gain;
    reflected_gain_ = 1 + glass * (gain - 1);
    multiple_ *= 1 - glass;
  }
  // A thin wall lets through all that the specular part leaves over, not only what comes through
  // after one scattering.
  if (!eta_ && is_isotropic && !film_)
    transmitted_ *= left_over(there) / std::max(there.white - greatest_.albedo(there), 1e-6F);

  // About what each part returns; none is left to chance too rarely, unless it is as good as
  // absent.
  const float reflected = luminance(f0 * (there.white - there.edge)) + specular_.f90 * there.edge;
  const float facets = reflected + luminance(transmitted_) * left_over(there);
  const float up =
      (luminance(diffuse_) * mean_left + luminance(multiple_) * (1 - mean.white)) / kInversePi;
  const float down = luminance(diffuse_below_) * mean_left / kInversePi;
  const float spread = up + down;
  facet_share_ = spread > 0.01F ? std::clamp(facets / (facets + spread), 0.1F, 0.9F) : 1;
  below_share_ = down > 0 ? std::clamp(down / spread, 0.1F, 0.9F) : 0;
}

template <typename Microfacets>
Vec3 BasicBsdf<Microfacets>::add_film() {
  // Its colours go up and down with the angle: below it is what it leaves over where it is
  // brightest.
  Vec3 mean(0);
  float bound = greatest_.f0;
  for (const float cosine : {0.25F, 0.5F, 0.75F, 1.0F}) {
    const Vec3 f = thin_film_reflectance(cosine, film_->ior, film_->thickness, specular_.f0);
    mean += 0.25F * f;
    const float edge = Schlick{.f0 = Vec3(0)}(cosine).x;
    bound = std::max(bound, (std::max({f.x, f.y, f.z}) - edge) / (1 - edge));
  }
  greatest_.f0 += film_->share * (std::min(bound, 1.0F) - greatest_.f0);
  greatest_.f90 += film_->share * (1 - greatest_.f90);
  return glm::mix(specular_.f0, mean, film_->share);
}

// Schlick's term takes the angle in the thinner medium.
template <typename Microfacets>
Vec3 BasicBsdf<Microfacets>::fresnel(float cosine) const {
  if (eta_ && *eta_ < 1) {
    const float square = 1 - (1 - cosine * cosine) / (*eta_ * *eta_);
    if (!(square > 0)) return Vec3(1);
    cosine = std::sqrt(square);
  }
  if (!film_) return specular_(cosine);
  return glm::mix(specular_(cosine),
                  thin_film_reflectance(cosine, film_->ior, film_->thickness, specular_.f0),
                  film_->share);
}

template <typename Microfacets>
float BasicBsdf<Microfacets>::reflected_share(const Vec3& fresnel) const {
  if (transmitted_ == Vec3(0)) return 1;
  const float reflected = luminance(fresnel);
  const float through = luminance((Vec3(1) - fresnel) * transmitted_);
  return reflected + through > 0 ? reflected / (reflected + through) : 1;
}

template <typename Microfacets>
Evaluation BasicBsdf<Microfacets>::above(const Vec3& wi, const Vec3& h) const {
  const float cosine = std::min(glm::dot(wo_, h), 1.0F);
  const float d = ggx_.distribution(h);
  const Albedo there = albedo_.at(wi.z);
  const Vec3 reflectance = fresnel(cosine);
  const Vec3 f = reflectance * (reflected_gain_ * d * ggx_.visibility(wo_, wi)) +
                 diffuse_ * left_over(there) + multiple_ * (1 - there.white);
  return {.value = f * wi.z,
          .density = facet_share_ * reflected_share(reflectance) * ggx_.reflected_density(wo_, d) +
                     (1 - facet_share_) * (1 - below_share_) * kInversePi * wi.z};
}

template <typename Microfacets>
Evaluation BasicBsdf<Microfacets>::below(const Vec3& wi) const {
  const float z_i = -wi.z;
  Evaluation e{.value = diffuse_below_ * (left_over(albedo_.at(z_i)) * z_i),
               .density = (1 - facet_share_) * below_share_ * kInversePi * z_i};
  if (transmitted_ == Vec3(0)) return e;
  if (!eta_) {
    const Vec3 up = mirrored(wi), h = unit(wo_ + up);
    const float d = ggx_.distribution(h);
    const Vec3 reflectance = fresnel(std::min(glm::dot(wo_, h), 1.0F));
    e.value += (Vec3(1) - reflectance) * transmitted_ * (d * ggx_.visibility(wo_, up) * z_i);
    e.density += facet_share_ * (1 - reflected_share(reflectance)) * ggx_.reflected_density(wo_, d);
    return e;
  }
  const Vec3 sum = wo_ + *eta_ * wi;
  const float square = glm::dot(sum, sum);
  if (!(square > 0)) return e;
  Vec3 h = sum / std::sqrt(square);
  if (h.z < 0) h = -h;
  const float cos_o = glm::dot(wo_, h), cos_i = glm::dot(wi, h);
  if (!(cos_o > 0) || !(cos_i < 0)) return e;
  const float denominator = cos_o + *eta_ * cos_i;
  const Vec3 reflectance = fresnel(std::min(cos_o, 1.0F));
  // Directions per normal; what wo sees of the facets, 2 / (z + root) = G1 / z.
  const float spreading = *eta_ * *eta_ * -cos_i / (denominator * denominator);
  const float seen = ggx_.distribution(h) * cos_o * 2 / (wo_.z + ggx_.root(wo_)) * spreading;
  const float unmasked = 2 * z_i / (z_i + ggx_.root(wi));
  if (!(seen < 1e30F)) return e;
  e.value += (Vec3(1) - reflectance) * transmitted_ * (seen * unmasked);
  e.density += facet_share_ * (1 - reflected_share(reflectance)) * seen;
  return e;
}

template <typename Microfacets>
Evaluation BasicBsdf<Microfacets>::evaluate(const Vec3& wi) const {
  if (wi.z > 0) return above(wi, unit(wo_ + wi));
  return wi.z < 0 ? below(wi) : Evaluation{};
}

template <typename Microfacets>
std::optional<DirectionSample> BasicBsdf<Microfacets>::sample(const Vec2& u, float lobe) const {
  Vec3 wi;
  Evaluation e;
  if (lobe < facet_share_) {
    const Vec3 h = ggx_.visible_normal(wo_, u);
    const float cosine = std::min(glm::dot(wo_, h), 1.0F);
    const Vec3 reflected = 2 * cosine * h - wo_;
    const bool is_reflected =
        transmitted_ == Vec3(0) || lobe < facet_share_ * reflected_share(fresnel(cosine));
    if (is_reflected) {
      wi = reflected;
      if (wi.z > 0) e = above(wi, h);
    } else {
      if (!eta_) {
        wi = mirrored(reflected);
      } else {
        // Not beyond total reflection, of which no sample is transmitted.
        const float along = 1 - (1 - cosine * cosine) / (*eta_ * *eta_);
        wi = (cosine / *eta_ - std::sqrt(std::max(along, 0.0F))) * h - wo_ / *eta_;
      }
      if (wi.z < 0) e = below(wi);
    }
  } else {
    wi = sampling::cosine_hemisphere(u);
    if (lobe - facet_share_ < (1 - facet_share_) * below_share_) wi.z = -wi.z;
    e = evaluate(wi);
  }
  if (!(e.density > 0)) return std::nullopt;
  return DirectionSample{.wi = wi, .weight = e.value / e.density, .density = e.density};
}

template class BasicBsdf<Ggx>;
template class BasicBsdf<AnisotropicGgx>;

}  // namespace microtrace::bsdf
