#pragma once
/// The nearest triangle to a point, by branch and bound over the tree.

#include "exact/nearest.hpp"
#include "queries/runs.hpp"
#include "queries/selection.hpp"
#include "queries/tree_target.hpp"
#include "queries/triangle_distance.hpp"

#include <microtrace/queries.hpp>

#include <limits>
#include <optional>

namespace microtrace {

class NearestSearch {
 public:
  NearestSearch(const TreeTarget& target, Selection selection)
      : target_(target), selection_(selection) {}

  /// p is in scene coordinates, and so is the result.
  [[nodiscard]] std::optional<NearestPoint> nearest(const Vec3& p, Poll& poll);

 private:
  /// A triangle; of duplicates `id` is the least that is selected.
  struct Candidate {
    PrimitiveId id;
    Triangle triangle;
    TriangleDistance distance;
  };

  void search_tree(const Vec3& p, Poll& poll);
  void consider(PrimitiveId id, const Triangle& triangle, const Vec3& p);
  /// Whether a candidate is nearer than the best so far, or as near with a lower id; the bounds of
  /// their distances overlap.
  [[nodiscard]] bool precedes(const Candidate& candidate, const Vec3& p);

  TreeTarget target_;
  Selection selection_;
  std::optional<Candidate> best_;             // the nearest so far
  std::optional<exact::Nearest> exact_best_;  // its exact distance, computed when first needed
  /// Boxes whose squared distance, computed with a few roundings, is above this are farther away
  /// than the best.
  double limit_ = std::numeric_limits<double>::infinity();
};

}  // namespace microtrace
