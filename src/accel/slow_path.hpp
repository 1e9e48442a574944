#pragma once
/// The stages behind the float32 kernels: float64 filters, then exact arithmetic.

#include "accel/closest_hit.hpp"
#include "accel/filters/filter.hpp"
#include "accel/kernels/kernel.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <optional>

namespace microtrace {

/// The best of a ray before there is one.
[[nodiscard]] inline Best no_hit(const Ray& ray) {
  return {.lo = ray.t_max, .hi = ray.t_max, .id = kNoPrimitive};
}

/// A hit with t in [lo, hi] in the kernels' form: the interval rounded outwards.
[[nodiscard]] Best outwards(double lo, double hi, PrimitiveId id);
[[nodiscard]] Best best_of(const ClosestHit& closest, const Ray& ray);

/// Where primitive id is hit, decided exactly.
[[nodiscard]] std::optional<exact::Root> exact_root(const Primitives& primitives, PrimitiveId id,
                                                    const Ray& ray);

class KnownHit;

/// One ray's questions to primitives, by number.
class Judge {
 public:
  /// All must outlive the judge. With `after` it only lets through hits that follow that one.
  Judge(const Primitives& primitives, const Ray& ray, const KnownHit* after = nullptr);

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
  const KnownHit* after_;
  bool filterable_;
};

/// The hit of a valid ray with a primitive, if there is one.
class KnownHit {
 public:
  /// Both must outlive it. id is a primitive's.
  KnownHit(const Primitives& primitives, const Ray& ray, PrimitiveId id);

  [[nodiscard]] bool exists() const { return exists_; }
  /// Around its exact t.
  [[nodiscard]] const exact::Enclosure& bounds() const { return bounds_; }
  /// Whether the hit of primitive id, if it has one, comes later: at a larger t, or at the same one
  /// with a larger number. The verdict is a filter's.
  [[nodiscard]] bool precedes(PrimitiveId id, const Verdict& verdict) const;

 private:
  const Primitives* primitives_;
  const Ray* ray_;
  PrimitiveId id_;
  bool exists_;
  exact::Enclosure bounds_{};
};

}  // namespace microtrace
