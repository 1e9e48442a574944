#pragma once
/// The stages that follow the float32 kernels: float64 filters, then exact arithmetic.

#include "accel/build/references/duplicates.hpp"
#include "accel/filters/filter.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/resolve/closest_hit_finder.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <limits>
#include <optional>

namespace microtrace {

/// Returns the initial value of a ray's nearest hit. t_scale is the result of kernel_t_scale for
/// the ray.
[[nodiscard]] inline ClosestSoFar no_hit(const Ray& ray, double t_scale = 1) {
  constexpr float kGreatest = std::numeric_limits<float>::max();
  const double end = ray.t_max * t_scale;  // exactly a float32 number unless it overflows
  const float t_max =
      end > kGreatest ? std::numeric_limits<float>::infinity() : static_cast<float>(end);
  return {.lo = t_max, .hi = t_max, .id = kNoPrimitive};
}

/// Returns a hit with t in [lo, hi] in the kernels' form, with the interval rounded outwards to
/// float32.
[[nodiscard]] ClosestSoFar outwards(double lo, double hi, PrimitiveId id);
[[nodiscard]] ClosestSoFar closest_so_far(const ClosestHitFinder& closest, const Ray& ray,
                                          double t_scale = 1);

class KnownHit;

/// Decides for one ray which primitives it hits and which hit is nearest.
class HitResolver {
 public:
  /// All referenced arguments must outlive this object. Values of t in kernels are t_scale times
  /// the ray's t. If `after` is given, only hits that follow it are considered.
  HitResolver(const Primitives& primitives, const Ray& ray, double t_scale = 1,
              const KnownHit* after = nullptr);

  /// Returns the initial value of the nearest hit.
  [[nodiscard]] ClosestSoFar no_hit() const { return microtrace::no_hit(*ray_, t_scale_); }

  /// Sets `best` to the hit with primitive `id` if that hit comes first. `best` may come from a
  /// kernel.
  void consider(std::uint32_t id, ClosestSoFar& best) const;

  /// Returns the filter's result for primitive `id`; unsure if a number exceeds the filters' limit.
  [[nodiscard]] FilterResult filtered(PrimitiveId id) const;

  /// Returns the hit with a primitive that the ray is known to hit, with t rounded once.
  [[nodiscard]] Hit hit(std::uint32_t id) const;

  /// Returns a callback for kernels. This object must outlive the result.
  [[nodiscard]] Fallback fallback();

 private:
  void consider(std::uint32_t id, ClosestHitFinder& closest) const;
  [[nodiscard]] Range range() const { return {.t_min = ray_->t_min, .t_max = ray_->t_max}; }

  const Primitives* primitives_;
  const Ray* ray_;
  double t_scale_;
  const KnownHit* after_;
  bool filterable_;
};

/// A valid ray's hit with a given primitive, if there is one. The hits that follow it can be found
/// by HitResolver.
class KnownHit {
 public:
  /// All referenced arguments must outlive this object. Only next() uses `duplicates`, which must
  /// be Tree::duplicates of the tree that the ray traverses.
  KnownHit(const Primitives& primitives, const Ray& ray, PrimitiveId id,
           const Duplicates& duplicates);

  [[nodiscard]] bool exists() const { return exists_; }
  /// Bounds of the hit's exact t.
  [[nodiscard]] const exact::Enclosure& bounds() const { return bounds_; }
  /// Returns the first primitive among `id` and its duplicates whose hit follows this one, given
  /// the filter's result for `id`. If its t is larger than this hit's, this is `id` itself; if t is
  /// equal, the lowest id above this hit's id. Returns nothing if there is no such primitive.
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
