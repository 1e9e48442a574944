#pragma once
/// Exact answers about a ray's hits: by integers of fixed width where they hold all numbers, else
/// by any width.

#include "exact/numbers/ratio.hpp"
#include "exact/numbers/root.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <compare>
#include <optional>

namespace microtrace {

class ExactHits {
 public:
  /// Both must outlive it.
  ExactHits(const Primitives& primitives, const Ray& ray) : primitives_(&primitives), ray_(&ray) {}

  /// Around the t at which the ray hits a primitive, if it does.
  [[nodiscard]] std::optional<exact::Enclosure> bounds(PrimitiveId id) const;

  /// The order of two hits.
  [[nodiscard]] std::strong_ordering order(PrimitiveId id, PrimitiveId other) const;

  /// A hit's t, rounded to the nearest float32.
  [[nodiscard]] float t(PrimitiveId id) const;

  /// A hit's t itself, by Dyadic.
  [[nodiscard]] std::optional<exact::Root> root(PrimitiveId id) const;

 private:
  const Primitives* primitives_;
  const Ray* ray_;
};

}  // namespace microtrace
