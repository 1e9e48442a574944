#pragma once
/// The stages after the float32 kernels: float64 filters, then exact arithmetic.

#include "accel/build/references/duplicates.hpp"
#include "accel/filters/filter.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/resolve/closest_hit.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <limits>
#include <optional>

namespace microtrace {

/// The initial value of a ray's nearest hit; t_scale is that of its kernel ray.
[[nodiscard]] inline ClosestSoFar no_hit(const Ray& ray, double t_scale = 1) {
  constexpr float kGreatest = std::numeric_limits<float>::max();
  const double end = ray.t_max * t_scale;  // a float32 unless it overflows
  const float t_max =
      end > kGreatest ? std::numeric_limits<float>::infinity() : static_cast<float>(end);
  return {.lo = t_max, .hi = t_max, .id = kNoPrimitive};
}

/// A hit with t in [lo, hi] in the kernels' form: the interval is rounded outwards.
[[nodiscard]] ClosestSoFar outwards(double lo, double hi, PrimitiveId id);
[[nodiscard]] ClosestSoFar closest_so_far(const ClosestHit& closest, const Ray& ray,
                                          double t_scale = 1);

class KnownHit;

/// Decides hits of one ray with primitives.
class HitResolver {
 public:
  /// All arguments must outlive this object. Values of t in kernels are t_scale times the ray's.
  /// With `after`, considers only hits that follow it.
  HitResolver(const Primitives& primitives, const Ray& ray, double t_scale = 1,
              const KnownHit* after = nullptr);

  /// The initial value of the nearest hit.
  [[nodiscard]] ClosestSoFar no_hit() const { return microtrace::no_hit(*ray_, t_scale_); }

  /// Updates best if primitive id is hit before it. best may come from a kernel.
  void consider(std::uint32_t id, ClosestSoFar& best) const;

  /// The filter's result for primitive id; unsure if the filters' limits are exceeded.
  [[nodiscard]] FilterResult filtered(PrimitiveId id) const;

  /// The hit with a primitive that the ray is known to hit, t rounded once.
  [[nodiscard]] Hit hit(std::uint32_t id) const;

  /// For kernels; this object must outlive the result.
  [[nodiscard]] Fallback fallback();

 private:
  void consider(std::uint32_t id, ClosestHit& closest) const;
  [[nodiscard]] Range range() const { return {.t_min = ray_->t_min, .t_max = ray_->t_max}; }

  const Primitives* primitives_;
  const Ray* ray_;
  double t_scale_;
  const KnownHit* after_;
  bool filterable_;
};

/// The hit of a valid ray with a primitive, if there is one.
class KnownHit {
 public:
  /// All arguments must outlive this object. `duplicates` are those of the primitives that will be
  /// queried.
  KnownHit(const Primitives& primitives, const Ray& ray, PrimitiveId id,
           const Duplicates& duplicates);

  [[nodiscard]] bool exists() const { return exists_; }
  /// Bounds of its exact t.
  [[nodiscard]] const exact::Enclosure& bounds() const { return bounds_; }
  /// The next hit among primitive `id` and its duplicates, given a filter's result for them: `id`
  /// itself if its t is larger; if t is equal, the least id above this hit's.
  [[nodiscard]] std::optional<PrimitiveId> next(PrimitiveId id, const FilterResult& filtered) const;

 private:
  const Primitives* primitives_;
  const Ray* ray_;
  PrimitiveId id_;
  const Duplicates* duplicates_;
  bool exists_;
  exact::Enclosure bounds_{};
};

}  // namespace microtrace
