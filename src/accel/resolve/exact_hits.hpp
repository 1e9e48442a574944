#pragma once
/// Exact queries about a ray's hits. They use fixed-width integers if these can represent all
/// numbers, otherwise arbitrary-width numbers.

#include "exact/numbers/ratio.hpp"
#include "exact/numbers/root.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <compare>
#include <optional>

namespace microtrace {

class ExactHits {
 public:
  /// Both arguments must outlive this object.
  ExactHits(const Primitives& primitives, const Ray& ray) : primitives_(&primitives), ray_(&ray) {}

  /// Returns bounds of the t at which the ray hits a primitive, or nothing if the ray misses it.
  [[nodiscard]] std::optional<exact::Enclosure> bounds(PrimitiveId id) const;

  /// Compares the exact t of the ray's hits with two primitives, both of which must exist.
  [[nodiscard]] std::strong_ordering order(PrimitiveId id, PrimitiveId other) const;

  /// Returns the t of the hit with a primitive, rounded to the nearest float32. The hit must exist.
  [[nodiscard]] float t(PrimitiveId id) const;

  /// Returns the exact t of the hit with a primitive, computed with Dyadic, or nothing if the ray
  /// misses it.
  [[nodiscard]] std::optional<exact::Root> root(PrimitiveId id) const;

 private:
  const Primitives* primitives_;
  const Ray* ray_;
};

}  // namespace microtrace
