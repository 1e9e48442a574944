#pragma once
/// The stages behind the float32 kernels: float64 filters, then exact arithmetic.

#include "accel/build/twins.hpp"
#include "accel/closest_hit.hpp"
#include "accel/filters/filter.hpp"
#include "accel/kernels/kernel.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <limits>
#include <optional>

namespace microtrace {

/// The best of a ray before there is one; t_scale is the one of its kernel ray.
[[nodiscard]] inline Best no_hit(const Ray& ray, double t_scale = 1) {
  constexpr float kGreatest = std::numeric_limits<float>::max();
  const double end = ray.t_max * t_scale;  // which is a float32 unless it is larger than they are
  const float t_max =
      end > kGreatest ? std::numeric_limits<float>::infinity() : static_cast<float>(end);
  return {.lo = t_max, .hi = t_max, .id = kNoPrimitive};
}

/// A hit with t in [lo, hi] in the kernels' form: the interval rounded outwards.
[[nodiscard]] Best outwards(double lo, double hi, PrimitiveId id);
[[nodiscard]] Best best_of(const ClosestHit& closest, const Ray& ray, double t_scale = 1);

class KnownHit;

/// One ray's questions to primitives, by number.
class Judge {
 public:
  /// All must outlive the judge. What kernels call t is t_scale times the ray's. With `after` only
  /// hits that follow that one are let through.
  Judge(const Primitives& primitives, const Ray& ray, double t_scale = 1,
        const KnownHit* after = nullptr);

  /// The best before there is one.
  [[nodiscard]] Best no_hit() const { return microtrace::no_hit(*ray_, t_scale_); }

  /// Takes primitive id into account; best may come from a kernel.
  void consider(std::uint32_t id, Best& best) const;

  /// What a filter says about primitive id; unsure where none may be asked.
  [[nodiscard]] Verdict verdict(PrimitiveId id) const;

  /// The hit of a primitive that the ray is known to hit, t rounded once.
  [[nodiscard]] Hit hit(std::uint32_t id) const;

  /// For kernels; the judge must outlive it.
  [[nodiscard]] SlowPath slow_path();

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
  /// All must outlive it. id is a primitive's; the twins are those of primitives that are asked.
  KnownHit(const Primitives& primitives, const Ray& ray, PrimitiveId id, const Twins& twins);

  [[nodiscard]] bool exists() const { return exists_; }
  /// Around its exact t.
  [[nodiscard]] const exact::Enclosure& bounds() const { return bounds_; }
  /// Of primitive id and its twins the one whose hit, if they have one, is the next: id itself
  /// where it is at a larger t, at the same one the least larger number. The verdict is a filter's.
  [[nodiscard]] std::optional<PrimitiveId> next(PrimitiveId id, const Verdict& verdict) const;

 private:
  const Primitives* primitives_;
  const Ray* ray_;
  PrimitiveId id_;
  const Twins* twins_;
  bool exists_;
  exact::Enclosure bounds_{};
};

}  // namespace microtrace
