#include "render/bsdf/layered.hpp"

#include "render/sampling/warps.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace::bsdf {
namespace {

std::variant<GeneralBsdf<Ggx>, GeneralBsdf<AnisotropicGgx>> base_of(const Parameters& p,
                                                                    const Coating* coating,
                                                                    const Vec3& wo) {
  if (p.anisotropy > 0) return GeneralBsdf<AnisotropicGgx>(p, coating, wo);
  return GeneralBsdf<Ggx>(p, coating, wo);
}

}  // namespace

LayeredBsdf::LayeredBsdf(const Parameters& base, const std::optional<Layers>& layers,
                         const Vec3& wo)
    : wo_(wo),
      over_(layers ? std::optional(Over{.layers = *layers, .coating = {*layers, base}})
                   : std::nullopt),
      base_(base_of(base, coating(), wo)) {
  if (!over_ || over_->layers.side == Layers::Side::below) return;
  const Coating& coating = over_->coating;
  over_->transmittance = coating.transmittance(wo);
  // In proportion to each layer's approximate albedo, with a minimum probability.
  if (coating.greatest_sheen() > 0) {
    over_->sheen_probability =
        std::max(0.5F * coating.greatest_sheen() * coating.sheen().albedo(wo.z), 0.1F);
  }
  if (layers->coat > 0)
    over_->coat_probability = std::max(0.8F * (1 - coating.coat_transmittance(wo)), 0.1F);
  over_->sheen_probability *= 1 - over_->coat_probability;
}

Evaluation LayeredBsdf::base(const Vec3& wi) const {
  return std::visit([&](const auto& base) { return base.evaluate(coating(), wi); }, base_);
}

void LayeredBsdf::add_sheen(const Vec3& wi, const Vec3& h, Evaluation& e) const {
  const Coating& coating = over_->coating;
  if (coating.greatest_sheen() == 0) return;
  const float through = std::min(coating.coat_transmittance(wo_), coating.coat_transmittance(wi));
  e.value += over_->layers.sheen * (coating.sheen().reflectance(wo_, wi, h) * through * wi.z);
  e.pdf += over_->sheen_probability * coating.sheen().pdf(wi.z);
}

void LayeredBsdf::add_coat(const Vec3& wi, const Vec3& h, Evaluation& e) const {
  if (over_->layers.coat == 0) return;
  const Frame& frame = over_->coating.coat_frame();
  const Vec3 o = frame.to_local(wo_), i = frame.to_local(wi);
  if (!(o.z > 0) || !(i.z > 0)) return;
  const Ggx& coat = over_->coating.coat();
  const float d = coat.distribution(frame.to_local(h));
  const float reflected = kCoat(std::min(glm::dot(wo_, h), 1.0F)).x;
  // The smaller of the cosines with either normal, for both directions: reciprocal, and never above
  // the coat's albedo.
  const float cosines = wi.z * std::min({1.0F, i.z / wi.z, o.z / wo_.z});
  e.value += Vec3(over_->layers.coat * reflected * d * coat.visibility(o.z, i.z) * cosines);
  e.pdf += over_->coat_probability * coat.reflected_pdf(o.z, d);
}

Evaluation LayeredBsdf::evaluate(const Vec3& wi) const {
  Evaluation e = base(wi);
  if (!over_) return e;
  e.pdf *= 1 - over_->coat_probability - over_->sheen_probability;
  const Layers::Side side = over_->layers.side;
  if (side == Layers::Side::above) {
    e.value *= wi.z > 0 ? std::min(over_->transmittance, over_->coating.transmittance(wi))
                        : over_->transmittance;
  } else if (side == Layers::Side::below && wi.z < 0) {
    e.value *= over_->coating.transmittance({wi.x, wi.y, -wi.z});
  }
  if (wi.z > 0 && side != Layers::Side::below) {
    const Vec3 h = unit(wo_ + wi);
    add_sheen(wi, h, e);
    add_coat(wi, h, e);
  }
  return e;
}

std::optional<DirectionSample> LayeredBsdf::sample(const Vec2& u, float lobe) const {
  Vec3 wi;
  const float coat = over_ ? over_->coat_probability : 0,
              sheen = over_ ? over_->sheen_probability : 0;
  if (lobe < coat) {
    const Frame& frame = over_->coating.coat_frame();
    const Vec3 o = frame.to_local(wo_), h = over_->coating.coat().visible_normal(o, u);
    const Vec3 i = 2 * glm::dot(o, h) * h - o;
    wi = frame.to_world(i);
    if (!(i.z > 0) || !(wi.z > 0)) return std::nullopt;
  } else if (lobe < coat + sheen) {
    wi = over_->coating.sheen().direction(u);
  } else {
    const float layers = coat + sheen, rest = sampling::reused(lobe, layers, 1 - layers);
    wi = std::visit([&](const auto& base) { return base.direction(u, rest); }, base_);
  }
  const Evaluation e = evaluate(wi);
  if (!(e.pdf > 0)) return std::nullopt;
  return DirectionSample{.wi = wi, .weight = e.value / e.pdf, .pdf = e.pdf};
}

}  // namespace microtrace::bsdf
