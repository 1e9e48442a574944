#pragma once
/// The nearest hit so far of one ray, kept exact: doubles around its t decide as long as they can,
/// exact arithmetic where two hits are too close to tell apart.

#include "accel/filters/filter.hpp"
#include "exact/root.hpp"

#include <microtrace/hit.hpp>

#include <concepts>
#include <optional>

namespace microtrace {

/// Gives the exact root of a primitive that the ray is known to hit.
template <class F>
concept RootOf = requires(const F& f, PrimitiveId id) {
  { f(id) } -> std::convertible_to<std::optional<exact::Root>>;
};

class ClosestHit {
 public:
  /// Takes the verdict of a filter on primitive `id` into account.
  void consider(PrimitiveId id, const Verdict& verdict, const RootOf auto& root_of) {
    if (verdict.certainty == Certainty::miss || verdict.lo > hi_) return;
    if (verdict.certainty == Certainty::hit && verdict.hi < lo_) {
      replace(id, {.lo = verdict.lo, .hi = verdict.hi});
      return;
    }
    consider_exactly(id, root_of);
  }

  struct Candidate {
    PrimitiveId id;
    double lo, hi;  ///< around the exact t
  };
  [[nodiscard]] std::optional<Candidate> candidate() const {
    if (!found_) return std::nullopt;
    return Candidate{.id = id_, .lo = lo_, .hi = hi_};
  }

  /// The hit with its t rounded to the nearest float32.
  [[nodiscard]] std::optional<Hit> rounded(const RootOf auto& root_of) const {
    if (!found_) return std::nullopt;
    const auto below = static_cast<float>(lo_), above = static_cast<float>(hi_);
    return Hit{.id = id_, .t = below == above ? below : exact::round_to_float(*root_of(id_))};
  }

 private:
  void consider_exactly(PrimitiveId id, const RootOf auto& root_of) {
    const std::optional<exact::Root> root = root_of(id);
    if (!root) return;
    const exact::Enclosure bounds = exact::enclose(*root);
    if (bounds.lo > hi_) return;
    if (!found_ || bounds.hi < lo_ || precedes(id, *root, *root_of(id_))) replace(id, bounds);
  }

  // Of equal t the lower number.
  [[nodiscard]] bool precedes(PrimitiveId id, const exact::Root& t, const exact::Root& best) const {
    const auto order = t <=> best;
    return order < 0 || (order == 0 && id < id_);
  }

  void replace(PrimitiveId id, const exact::Enclosure& bounds) {
    id_ = id;
    lo_ = bounds.lo;
    hi_ = bounds.hi;
    found_ = true;
  }

  // No hit yet counts as one at infinity.
  double lo_ = std::numeric_limits<double>::infinity();
  double hi_ = std::numeric_limits<double>::infinity();
  PrimitiveId id_ = 0;
  bool found_ = false;
};

}  // namespace microtrace
