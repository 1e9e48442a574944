#include "render/bsdf/bsdf.hpp"

#include "render/bsdf/frame.hpp"
#include "render/sampling/warps.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace::bsdf {
namespace {

/// Of a dielectric with index of refraction 1.5.
constexpr float kDielectricF0 = 0.04F;

float fifth_power(float x) {
  const float square = x * x;
  return square * square * x;
}

/// C. Schlick, An inexpensive BRDF model for physically-based rendering, 1994.
Vec3 schlick(const Vec3& f0, float cosine) {
  return f0 + (Vec3(1) - f0) * fifth_power(1 - cosine);
}

float luminance(const Vec3& c) {
  return 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z;
}

/// Of light that single reflections do not return, the share that several do; `mean` is the white
/// albedo's (Kulla and Conty).
template <typename Color>
Color returned_later(const Color& f0, float mean) {
  const Color fresnel = f0 + (Color(1) - f0) * (1 / 21.0F);
  return fresnel * fresnel * mean / (Color(1) - fresnel * (1 - mean));
}

}  // namespace

Bsdf::Bsdf(const Parameters& p, const Vec3& wo)
    : wo_(wo),
      ggx_(p.roughness),
      albedo_(ggx_),
      dielectric_white_(kDielectricF0),
      f0_(kDielectricF0 + p.metallic * (p.base_color - Vec3(kDielectricF0))) {
  const Albedo mean = albedo_.mean(), there = albedo_.at(wo.z);
  dielectric_rest_ = returned_later(dielectric_white_, mean.white);
  multiple_ = returned_later(f0_, mean.white) *
              (kInversePi / std::max(1 - mean.white, 1e-6F) * (1 - there.white));
  diffuse_ = (1 - p.metallic) * kInversePi * left_over(there) / left_over(mean) * p.base_color;

  // About what each part returns; neither is left to chance too rarely, unless it is as good as
  // absent.
  const float specular = luminance(f0_ * (there.white - there.edge) + Vec3(there.edge));
  const float spread =
      (luminance(diffuse_) * left_over(mean) + luminance(multiple_) * (1 - mean.white)) /
      kInversePi;
  specular_share_ = spread > 0.01F ? std::clamp(specular / (specular + spread), 0.1F, 0.9F) : 1;
}

Evaluation Bsdf::evaluate(const Vec3& wi, const Vec3& h) const {
  if (!(wi.z > 0)) return {};
  const float cosine = std::min(glm::dot(wo_, h), 1.0F);
  const float d = ggx_.distribution(h);
  const Albedo there = albedo_.at(wi.z);
  const Vec3 f = schlick(f0_, cosine) * (d * ggx_.visibility(wo_.z, wi.z)) +
                 diffuse_ * left_over(there) + multiple_ * (1 - there.white);
  return {.value = f * wi.z,
          .density = specular_share_ * ggx_.reflected_density(wo_.z, d) +
                     (1 - specular_share_) * kInversePi * wi.z};
}

Evaluation Bsdf::evaluate(const Vec3& wi) const {
  if (!(wi.z > 0)) return {};
  return evaluate(wi, unit(wo_ + wi));
}

std::optional<DirectionSample> Bsdf::sample(const Vec2& u, float lobe) const {
  Vec3 wi, h;
  if (lobe < specular_share_) {
    h = ggx_.visible_normal(wo_, u);
    wi = 2 * glm::dot(wo_, h) * h - wo_;
  } else {
    wi = sampling::cosine_hemisphere(u);
    h = unit(wo_ + wi);
  }
  const Evaluation e = evaluate(wi, h);
  if (!(e.density > 0)) return std::nullopt;
  return DirectionSample{.wi = wi, .weight = e.value / e.density, .density = e.density};
}

}  // namespace microtrace::bsdf
