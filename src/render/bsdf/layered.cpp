#include "render/bsdf/layered.hpp"

#include "render/sampling/warps.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace::bsdf {
namespace {

/// Of index of refraction 1.5.
constexpr Schlick kCoat{};

std::variant<Bsdf, AnisotropicBsdf> base_of(const Parameters& p, const Vec3& wo) {
  if (p.anisotropy > 0) return AnisotropicBsdf(p, wo);
  return Bsdf(p, wo);
}

}  // namespace

LayeredBsdf::LayeredBsdf(const Parameters& base, const Layers& layers, const Vec3& wo)
    : base_(base_of(base, wo)),
      layers_(layers),
      wo_(wo),
      sheen_(layers.sheen_roughness),
      greatest_sheen_(std::max({layers.sheen.x, layers.sheen.y, layers.sheen.z})),
      coat_(layers.coat_roughness),
      coat_albedo_(coat_),
      coat_frame_(Frame::about(layers.coat_normal)) {
  if (layers_.side == Layers::Side::below) return;
  coat_passed_ = through_coat(wo);
  sheen_passed_ = through_sheen(wo);
  // About what each returns, and neither too rarely.
  if (greatest_sheen_ > 0)
    sheen_share_ = std::max(0.5F * greatest_sheen_ * sheen_.albedo(wo.z), 0.1F);
  if (layers_.coat > 0) coat_share_ = std::max(0.8F * (1 - coat_passed_), 0.1F);
  sheen_share_ *= 1 - coat_share_;
}

float LayeredBsdf::through_coat(const Vec3& w) const {
  if (layers_.coat == 0) return 1;
  const Albedo albedo = coat_albedo_.at(std::clamp(coat_frame_.to_local(w).z, 0.0F, 1.0F));
  return 1 - layers_.coat * (kCoat.f0.x * (albedo.white - albedo.edge) + albedo.edge);
}

float LayeredBsdf::through_sheen(const Vec3& w) const {
  return greatest_sheen_ > 0 ? 1 - greatest_sheen_ * sheen_.albedo(w.z) : 1;
}

float LayeredBsdf::passed(const Vec3& w) const {
  return through_coat(w) * through_sheen(w);
}

Evaluation LayeredBsdf::base(const Vec3& wi) const {
  return std::visit([&](const auto& base) { return base.evaluate(wi); }, base_);
}

void LayeredBsdf::add_sheen(const Vec3& wi, const Vec3& h, Evaluation& e) const {
  if (greatest_sheen_ == 0) return;
  e.value += layers_.sheen * (sheen_.reflectance(wo_, wi, h) * coat_passed_ * wi.z);
  e.density += sheen_share_ * kInversePi * wi.z;
}

void LayeredBsdf::add_coat(const Vec3& wi, const Vec3& h, Evaluation& e) const {
  if (layers_.coat == 0) return;
  const Vec3 o = coat_frame_.to_local(wo_), i = coat_frame_.to_local(wi);
  if (!(o.z > 0) || !(i.z > 0)) return;
  const float d = coat_.distribution(coat_frame_.to_local(h));
  const float reflected = kCoat(std::min(glm::dot(wo_, h), 1.0F)).x;
  e.value += Vec3(layers_.coat * reflected * d * coat_.visibility(o.z, i.z) * i.z);
  e.density += coat_share_ * coat_.reflected_density(o.z, d);
}

Evaluation LayeredBsdf::evaluate(const Vec3& wi) const {
  Evaluation e = base(wi);
  e.density *= 1 - coat_share_ - sheen_share_;
  const Layers::Side side = layers_.side;
  if (wi.z > 0 && side != Layers::Side::below) {
    e.value *= coat_passed_ * std::min(sheen_passed_, through_sheen(wi));
    const Vec3 h = unit(wo_ + wi);
    add_sheen(wi, h, e);
    add_coat(wi, h, e);
  } else if (wi.z < 0) {
    const Vec3 mirrored(wi.x, wi.y, -wi.z);
    const float out = coat_passed_ * sheen_passed_;
    e.value *= side == Layers::Side::above ? out : std::min(out, passed(mirrored));
  }
  return e;
}

std::optional<DirectionSample> LayeredBsdf::sample(const Vec2& u, float lobe) const {
  Vec3 wi;
  if (lobe < coat_share_) {
    const Vec3 h = coat_frame_.to_world(coat_.visible_normal(coat_frame_.to_local(wo_), u));
    wi = 2 * glm::dot(wo_, h) * h - wo_;
    if (!(wi.z > 0)) return std::nullopt;
  } else if (lobe < coat_share_ + sheen_share_) {
    wi = sampling::cosine_hemisphere(u);
  } else {
    const float layers = coat_share_ + sheen_share_;
    const float rest = sampling::reused(lobe, layers, 1 - layers);
    const auto below = std::visit([&](const auto& base) { return base.sample(u, rest); }, base_);
    if (!below) return std::nullopt;
    wi = below->wi;
  }
  const Evaluation e = evaluate(wi);
  if (!(e.density > 0)) return std::nullopt;
  return DirectionSample{.wi = wi, .weight = e.value / e.density, .density = e.density};
}

}  // namespace microtrace::bsdf
