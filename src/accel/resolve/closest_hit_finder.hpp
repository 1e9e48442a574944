#pragma once
/// The nearest hit so far of one ray. Two hits are compared by their float64 bounds of t, or by
/// exact arithmetic if the bounds overlap.

#include "accel/filters/filter.hpp"
#include "accel/resolve/exact_hits.hpp"

#include <microtrace/hit.hpp>

#include <limits>
#include <optional>

namespace microtrace {

class ClosestHitFinder {
 public:
  /// Updates the nearest hit, given the filter's result for primitive `id`.
  void consider(PrimitiveId id, const FilterResult& filtered, const ExactHits& exactly) {
    if (filtered.certainty == Certainty::miss || filtered.lo > hi_) return;
    const std::optional<exact::Enclosure> bounds =
        filtered.certainty == Certainty::hit
            ? exact::Enclosure{.lo = filtered.lo, .hi = filtered.hi}
            : exactly.bounds(id);
    if (!bounds || bounds->lo > hi_) return;
    if (!found_ || bounds->hi < lo_ || precedes(id, exactly)) replace(id, *bounds);
  }

  struct Candidate {
    PrimitiveId id;
    double lo, hi;  ///< bounds of the exact t
  };
  [[nodiscard]] std::optional<Candidate> candidate() const {
    if (!found_) return std::nullopt;
    return Candidate{.id = id_, .lo = lo_, .hi = hi_};
  }

  /// Returns the nearest hit, with t rounded to the nearest float32.
  [[nodiscard]] std::optional<Hit> rounded(const ExactHits& exactly) const {
    if (!found_) return std::nullopt;
    const auto t = exact::rounded({.lo = lo_, .hi = hi_});
    return Hit{.id = id_, .t = t ? *t : exactly.t(id_)};
  }

 private:
  // Of hits at the same t, the one with the lower id comes first.
  [[nodiscard]] bool precedes(PrimitiveId id, const ExactHits& exactly) const {
    const auto order = exactly.order(id, id_);
    return order < 0 || (order == 0 && id < id_);
  }

  void replace(PrimitiveId id, const exact::Enclosure& bounds) {
    id_ = id;
    lo_ = bounds.lo;
    hi_ = bounds.hi;
    found_ = true;
  }

  // Infinite while there is no hit.
  double lo_ = std::numeric_limits<double>::infinity();
  double hi_ = std::numeric_limits<double>::infinity();
  PrimitiveId id_ = 0;
  bool found_ = false;
};

}  // namespace microtrace
