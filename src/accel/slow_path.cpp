#include "accel/slow_path.hpp"

#include "accel/filters/shape_filter.hpp"
#include "accel/stage_counts.hpp"

#include <cmath>

namespace microtrace {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float rounded_down(double x) {
  const auto f = static_cast<float>(x);
  return f > x ? std::nextafter(f, -kInfinity) : f;
}
float rounded_up(double x) {
  const auto f = static_cast<float>(x);
  return f < x ? std::nextafter(f, kInfinity) : f;
}

}  // namespace

Best outwards(double lo, double hi, PrimitiveId id) {
  return {.lo = rounded_down(lo), .hi = rounded_up(hi), .id = id};
}

Best best_of(const ClosestHit& closest, const Ray& ray, double t_scale) {
  const auto found = closest.candidate();
  return found ? outwards(found->lo * t_scale, found->hi * t_scale, found->id)
               : no_hit(ray, t_scale);
}

Judge::Judge(const Primitives& primitives, const Ray& ray, double t_scale, const KnownHit* after)
    : primitives_(&primitives),
      ray_(&ray),
      t_scale_(t_scale),
      after_(after),
      filterable_(is_filterable(ray.o) && is_filterable(ray.d)) {}

void Judge::consider(std::uint32_t id, Best& best) const {
  ++slow_stages.filters;
  if (id == best.id) return;  // a triangle that was split among leaves is tested more than once
  ClosestHit closest;
  if (best.id != kNoPrimitive) consider(best.id, closest);
  consider(id, closest);
  if (closest.candidate()) best = best_of(closest, *ray_, t_scale_);
}

Hit Judge::hit(std::uint32_t id) const {
  // For a triangle that is certainly hit, its plane gives t.
  const auto verdict_on = [this](const auto& shape) {
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Triangle>)
      return TrianglePlaneFilter(shape, ray_->o)(DVec3(ray_->d), range());
    else
      return seen_from(ray_->o, shape)(DVec3(ray_->d), range());
  };
  return primitives_->visit(id, [&](const auto& shape) {
    if (filterable_ && is_filterable(shape)) {
      const Verdict verdict = verdict_on(shape);
      const auto below = static_cast<float>(verdict.lo), above = static_cast<float>(verdict.hi);
      if (verdict.certainty == Certainty::hit && below == above) return Hit{.id = id, .t = below};
    }
    return Hit{.id = id, .t = ExactHits(*primitives_, *ray_).t(id)};
  });
}

SlowPath Judge::slow_path() {
  return {.context = this, .consider = [](void* judge, std::uint32_t id, Best& best) {
            static_cast<const Judge*>(judge)->consider(id, best);
          }};
}

void Judge::consider(std::uint32_t id, ClosestHit& closest) const {
  const Verdict verdict = this->verdict(id);
  const auto next = after_ == nullptr ? std::optional(id) : after_->next(id, verdict);
  if (next) closest.consider(*next, verdict, ExactHits(*primitives_, *ray_));
}

Verdict Judge::verdict(PrimitiveId id) const {
  return primitives_->visit(id, [&](const auto& shape) {
    if (!filterable_ || !is_filterable(shape)) return Verdict{.certainty = Certainty::unsure};
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Triangle>) {
      // Usually the triangle that the ray has just left; the cheaper plane test rejects it.
      const Verdict plane = TrianglePlaneFilter(shape, ray_->o)(DVec3(ray_->d), range());
      if (plane.certainty == Certainty::miss) return plane;
    }
    return seen_from(ray_->o, shape)(DVec3(ray_->d), range());
  });
}

KnownHit::KnownHit(const Primitives& primitives, const Ray& ray, PrimitiveId id, const Twins& twins)
    : primitives_(&primitives), ray_(&ray), id_(id), twins_(&twins) {
  const Verdict verdict = Judge(primitives, ray).verdict(id);
  exists_ = verdict.certainty == Certainty::hit;
  bounds_ = {.lo = verdict.lo, .hi = verdict.hi};
  if (verdict.certainty != Certainty::unsure) return;
  const auto bounds = ExactHits(primitives, ray).bounds(id);
  exists_ = bounds.has_value();
  if (bounds) bounds_ = *bounds;
}

std::optional<PrimitiveId> KnownHit::next(PrimitiveId id, const Verdict& verdict) const {
  if (id == twins_->representative(id_)) return twins_->above(id, id_);
  if (verdict.certainty == Certainty::miss || verdict.lo > bounds_.hi) return id;
  if (verdict.certainty == Certainty::hit && verdict.hi < bounds_.lo) return std::nullopt;
  const ExactHits exactly(*primitives_, *ray_);
  if (verdict.certainty != Certainty::hit && !exactly.bounds(id)) return id;
  const auto order = exactly.order(id, id_);
  if (order == 0) return twins_->above(id, id_);
  return order > 0 ? std::optional(id) : std::nullopt;
}

}  // namespace microtrace
