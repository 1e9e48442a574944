#pragma once
/// The nearest hit so far of one ray. Compares bounds of t in float64 if possible; compares two
/// hits whose bounds overlap by exact arithmetic.

#include "accel/filters/filter.hpp"
#include "accel/resolve/exact_hits.hpp"

#include <microtrace/hit.hpp>

#include <limits>
#include <optional>

namespace microtrace {

class ClosestHit {
 public:
  /// Considers the filter result for primitive `id`.
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

  /// The hit with its t rounded to the nearest float32.
  [[nodiscard]] std::optional<Hit> rounded(const ExactHits& exactly) const {
    if (!found_) return std::nullopt;
    const auto below = static_cast<float>(lo_), above = static_cast<float>(hi_);
    return Hit{.id = id_, .t = below == above ? below : exactly.t(id_)};
  }

 private:
  // Ties go to the lower id.
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

  // A ray without a hit has t at infinity.
  double lo_ = std::numeric_limits<double>::infinity();
  double hi_ = std::numeric_limits<double>::infinity();
  PrimitiveId id_ = 0;
  bool found_ = false;
};

}  // namespace microtrace
