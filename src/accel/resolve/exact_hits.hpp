#pragma once
/// Exact results about a ray's hits, computed with fixed-width integers if these can represent all
/// numbers, else with arbitrary-width numbers.

#include "exact/numbers/ratio.hpp"
#include "exact/numbers/root.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <compare>
#include <optional>

namespace microtrace {

class ExactHits {
 public:
  /// Both must outlive this object.
  ExactHits(const Primitives& primitives, const Ray& ray) : primitives_(&primitives), ray_(&ray) {}

  /// Bounds of the t at which the ray hits a primitive; nothing if it misses.
  [[nodiscard]] std::optional<exact::Enclosure> bounds(PrimitiveId id) const;

  /// The order of two hits.
  [[nodiscard]] std::strong_ordering order(PrimitiveId id, PrimitiveId other) const;

  /// A hit's t, rounded to the nearest float32.
  [[nodiscard]] float t(PrimitiveId id) const;

  /// The exact t of a hit, computed with Dyadic.
  [[nodiscard]] std::optional<exact::Root> root(PrimitiveId id) const;

 private:
  const Primitives* primitives_;
  const Ray* ray_;
};

}  // namespace microtrace
