#include "accel/resolve/hit_resolver.hpp"

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

ClosestSoFar outwards(double lo, double hi, PrimitiveId id) {
  return {.lo = rounded_down(lo), .hi = rounded_up(hi), .id = id};
}

ClosestSoFar closest_so_far(const ClosestHitFinder& closest, const Ray& ray, double t_scale) {
  const auto found = closest.candidate();
  return found ? outwards(found->lo * t_scale, found->hi * t_scale, found->id)
               : no_hit(ray, t_scale);
}

HitResolver::HitResolver(const Primitives& primitives, const Ray& ray, double t_scale,
                         const KnownHit* after)
    : primitives_(&primitives),
      ray_(&ray),
      t_scale_(t_scale),
      after_(after),
      filterable_(is_filterable(ray.o) && is_filterable(ray.d)) {}

void HitResolver::consider(std::uint32_t id, ClosestSoFar& best) const {
  ++fallback_stages.filters;
  if (id == best.id) return;  // a triangle can be in several leaves
  ClosestHitFinder closest;
  if (best.id != kNoPrimitive) consider(best.id, closest);
  consider(id, closest);
  if (closest.candidate()) best = closest_so_far(closest, *ray_, t_scale_);
}

Hit HitResolver::hit(std::uint32_t id) const {
  // The ray certainly hits, so for a triangle t can be computed from its plane alone.
  const auto filtered_by = [this](const auto& shape) {
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Triangle>)
      return TrianglePlaneFilter(shape, ray_->o)(DVec3(ray_->d), range());
    else
      return seen_from(ray_->o, shape)(DVec3(ray_->d), range());
  };
  return primitives_->visit(id, [&](const auto& shape) {
    if (filterable_ && is_filterable(shape)) {
      const FilterResult filtered = filtered_by(shape);
      const auto t = exact::rounded({.lo = filtered.lo, .hi = filtered.hi});
      if (filtered.certainty == Certainty::hit && t) return Hit{.id = id, .t = *t};
    }
    return Hit{.id = id, .t = ExactHits(*primitives_, *ray_).t(id)};
  });
}

Fallback HitResolver::fallback() {
  return {.context = this, .consider = [](void* resolver, std::uint32_t id, ClosestSoFar& best) {
            static_cast<const HitResolver*>(resolver)->consider(id, best);
          }};
}

void HitResolver::consider(std::uint32_t id, ClosestHitFinder& closest) const {
  const FilterResult filtered = this->filtered(id);
  const auto next = after_ == nullptr ? std::optional(id) : after_->next(id, filtered);
  if (next) closest.consider(*next, filtered, ExactHits(*primitives_, *ray_));
}

FilterResult HitResolver::filtered(PrimitiveId id) const {
  return primitives_->visit(id, [&](const auto& shape) {
    if (!filterable_ || !is_filterable(shape)) return FilterResult{.certainty = Certainty::unsure};
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Triangle>) {
      // This is usually the triangle that the ray has just left, which the cheaper plane test
      // rejects.
      const FilterResult plane = TrianglePlaneFilter(shape, ray_->o)(DVec3(ray_->d), range());
      if (plane.certainty == Certainty::miss) return plane;
    }
    return seen_from(ray_->o, shape)(DVec3(ray_->d), range());
  });
}

KnownHit::KnownHit(const Primitives& primitives, const Ray& ray, PrimitiveId id,
                   const Duplicates& duplicates)
    : primitives_(&primitives), ray_(&ray), id_(id), duplicates_(&duplicates) {
  const FilterResult filtered = HitResolver(primitives, ray).filtered(id);
  exists_ = filtered.certainty == Certainty::hit;
  bounds_ = {.lo = filtered.lo, .hi = filtered.hi};
  if (filtered.certainty != Certainty::unsure) return;
  const auto bounds = ExactHits(primitives, ray).bounds(id);
  exists_ = bounds.has_value();
  if (bounds) bounds_ = *bounds;
}

std::optional<PrimitiveId> KnownHit::next(PrimitiveId id, const FilterResult& filtered) const {
  if (id == duplicates_->representative(id_)) return duplicates_->above(id, id_);
  if (filtered.certainty == Certainty::miss || filtered.lo > bounds_.hi) return id;
  if (filtered.certainty == Certainty::hit && filtered.hi < bounds_.lo) return std::nullopt;
  const ExactHits exactly(*primitives_, *ray_);
  if (filtered.certainty != Certainty::hit && !exactly.bounds(id)) return id;
  const auto order = exactly.order(id, id_);
  if (order == 0) return duplicates_->above(id, id_);
  return order > 0 ? std::optional(id) : std::nullopt;
}

}  // namespace microtrace
