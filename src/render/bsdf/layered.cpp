#include "render/bsdf/layered.hpp"

#include "render/sampling/warps.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace::bsdf {
namespace {

std::variant<GeneralBsdf<Ggx>, GeneralBsdf<AnisotropicGgx>> base_of(const Parameters& p,
                                                                    const Cover* cover,
                                                                    const Vec3& wo) {
  if (p.anisotropy > 0) return GeneralBsdf<AnisotropicGgx>(p, cover, wo);
  return GeneralBsdf<Ggx>(p, cover, wo);
}

}  // namespace

LayeredBsdf::LayeredBsdf(const Parameters& base, const std::optional<Layers>& layers,
                         const Vec3& wo)
    : wo_(wo),
      over_(layers ? std::optional(Over{.layers = *layers, .cover = {*layers, base}})
                   : std::nullopt),
      base_(base_of(base, cover(), wo)) {
  if (!over_ || over_->layers.side == Layers::Side::below) return;
  const Cover& cover = over_->cover;
  over_->passed = cover.passed(wo);
  // About what each returns, and neither too rarely.
  if (cover.greatest_sheen() > 0) {
    over_->sheen_share = std::max(0.5F * cover.greatest_sheen() * cover.sheen().albedo(wo.z), 0.1F);
  }
  if (layers->coat > 0) over_->coat_share = std::max(0.8F * (1 - cover.through_coat(wo)), 0.1F);
  over_->sheen_share *= 1 - over_->coat_share;
}

Evaluation LayeredBsdf::base(const Vec3& wi) const {
  return std::visit([&](const auto& base) { return base.evaluate(cover(), wi); }, base_);
}

void LayeredBsdf::add_sheen(const Vec3& wi, const Vec3& h, Evaluation& e) const {
  const Cover& cover = over_->cover;
  if (cover.greatest_sheen() == 0) return;
  const float through = std::min(cover.through_coat(wo_), cover.through_coat(wi));
  e.value += over_->layers.sheen * (cover.sheen().reflectance(wo_, wi, h) * through * wi.z);
  e.density += over_->sheen_share * cover.sheen().density(wi.z);
}

void LayeredBsdf::add_coat(const Vec3& wi, const Vec3& h, Evaluation& e) const {
  if (over_->layers.coat == 0) return;
  const Frame& frame = over_->cover.coat_frame();
  const Vec3 o = frame.to_local(wo_), i = frame.to_local(wi);
  if (!(o.z > 0) || !(i.z > 0)) return;
  const Ggx& coat = over_->cover.coat();
  const float d = coat.distribution(frame.to_local(h));
  const float reflected = kCoat(std::min(glm::dot(wo_, h), 1.0F)).x;
  // Of cosines by either normal the lesser, on both ways: so it is reciprocal, and returns no more
  // than the coat is taken to.
  const float cosines = wi.z * std::min({1.0F, i.z / wi.z, o.z / wo_.z});
  e.value += Vec3(over_->layers.coat * reflected * d * coat.visibility(o.z, i.z) * cosines);
  e.density += over_->coat_share * coat.reflected_density(o.z, d);
}

Evaluation LayeredBsdf::evaluate(const Vec3& wi) const {
  Evaluation e = base(wi);
  if (!over_) return e;
  e.density *= 1 - over_->coat_share - over_->sheen_share;
  const Layers::Side side = over_->layers.side;
  if (side == Layers::Side::above) {
    e.value *= wi.z > 0 ? std::min(over_->passed, over_->cover.passed(wi)) : over_->passed;
  } else if (side == Layers::Side::below && wi.z < 0) {
    e.value *= over_->cover.passed({wi.x, wi.y, -wi.z});
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
  const float coat = over_ ? over_->coat_share : 0, sheen = over_ ? over_->sheen_share : 0;
  if (lobe < coat) {
    const Frame& frame = over_->cover.coat_frame();
    const Vec3 o = frame.to_local(wo_), h = over_->cover.coat().visible_normal(o, u);
    const Vec3 i = 2 * glm::dot(o, h) * h - o;
    wi = frame.to_world(i);
    if (!(i.z > 0) || !(wi.z > 0)) return std::nullopt;
  } else if (lobe < coat + sheen) {
    wi = over_->cover.sheen().direction(u);
  } else {
    const float layers = coat + sheen, rest = sampling::reused(lobe, layers, 1 - layers);
    wi = std::visit([&](const auto& base) { return base.direction(u, rest); }, base_);
  }
  const Evaluation e = evaluate(wi);
  if (!(e.density > 0)) return std::nullopt;
  return DirectionSample{.wi = wi, .weight = e.value / e.density, .density = e.density};
}

}  // namespace microtrace::bsdf
