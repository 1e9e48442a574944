#include "render/bsdf/bsdf.hpp"

#include "render/bsdf/frame.hpp"
#include "render/bsdf/multiple_scattering.hpp"
#include "render/luminance.hpp"
#include "render/sampling/warps.hpp"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace::bsdf {

Bsdf::Bsdf(const Parameters& p, const Vec3& wo)
    : wo_(wo),
      ggx_(p.roughness),
      albedo_(ggx_),
      specular_{.f0 = p.dielectric.f0 + p.metallic * (p.base_color - p.dielectric.f0),
                .f90 = p.dielectric.f90 + p.metallic * (1 - p.dielectric.f90)},
      greatest_{.f0 = std::max({p.dielectric.f0.x, p.dielectric.f0.y, p.dielectric.f0.z}),
                .f90 = p.dielectric.f90} {
  const Albedo mean = albedo_.mean(), there = albedo_.at(wo.z);
  multiply_reflected_ = multiple_scattering(greatest_.f0, greatest_.f90, mean.f1);
  multiple_ = multiple_scattering(specular_.f0, specular_.f90, mean.f1) *
              (kInversePi / std::max(1 - mean.f1, 1e-6F) * (1 - there.f1));
  const float mean_left = std::max(unreflected(mean), 1e-6F);
  const Vec3 diffuse((1 - p.metallic) * kInversePi * unreflected(there) / mean_left);
  diffuse_ = diffuse * p.base_color;

  // In proportion to each lobe's approximate albedo, with a minimum probability unless the lobe is
  // negligible.
  const float facets =
      luminance(specular_.f0 * (there.f1 - there.schlick)) + specular_.f90 * there.schlick;
  const float spread =
      (luminance(diffuse_) * mean_left + luminance(multiple_) * (1 - mean.f1)) / kInversePi;
  facet_probability_ = spread > 0.01F ? std::clamp(facets / (facets + spread), 0.1F, 0.9F) : 1;
}

Evaluation Bsdf::above(const Vec3& wi, const Vec3& h) const {
  const float cosine = std::min(glm::dot(wo_, h), 1.0F);
  const float d = ggx_.distribution(h);
  const Albedo there = albedo_.at(wi.z);
  const Vec3 f = specular_(cosine) * (d * ggx_.visibility(wo_.z, wi.z)) +
                 diffuse_ * unreflected(there) + multiple_ * (1 - there.f1);
  return {.value = f * wi.z,
          .pdf = facet_probability_ * ggx_.reflected_pdf(wo_.z, d) +
                 (1 - facet_probability_) * kInversePi * wi.z};
}

Evaluation Bsdf::evaluate(const Vec3& wi) const {
  return wi.z > 0 ? above(wi, unit(wo_ + wi)) : Evaluation{};
}

std::optional<DirectionSample> Bsdf::sample(const Vec2& u, float lobe) const {
  Vec3 wi;
  Evaluation e;
  if (lobe < facet_probability_) {
    const Vec3 h = ggx_.visible_normal(wo_, u);
    wi = 2 * std::min(glm::dot(wo_, h), 1.0F) * h - wo_;
    if (wi.z > 0) e = above(wi, h);
  } else {
    wi = sampling::cosine_hemisphere(u);
    e = evaluate(wi);
  }
  if (!(e.pdf > 0)) return std::nullopt;
  return DirectionSample{.wi = wi, .weight = e.value / e.pdf, .pdf = e.pdf};
}

}  // namespace microtrace::bsdf
