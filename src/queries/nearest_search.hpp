#pragma once
/// Finds the triangle nearest to a point by branch and bound over the tree.

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

  /// Returns the nearest point, or nothing if there are no triangles. p and the result are in scene
  /// coordinates.
  [[nodiscard]] std::optional<NearestPoint> nearest(const Vec3& p, Poll& poll);

 private:
  /// A triangle and its distance. If the triangle has duplicates, `id` is the lowest selected id.
  struct Candidate {
    PrimitiveId id;
    Triangle triangle;
    TriangleDistance distance;
  };

  void search_tree(const Vec3& p, Poll& poll);
  void consider(PrimitiveId id, const Triangle& triangle, const Vec3& p);
  /// Returns true if a candidate is nearer than the best so far, or equally near with a lower id.
  /// Must be called only if the bounds of both distances overlap.
  [[nodiscard]] bool precedes(const Candidate& candidate, const Vec3& p);

  TreeTarget target_;
  Selection selection_;
  std::optional<Candidate> best_;             // the nearest triangle so far
  std::optional<exact::Nearest> exact_best_;  // its exact distance, computed on first use
  /// Boxes whose rounded squared distance exceeds this limit are certainly farther away than best_.
  double limit_ = std::numeric_limits<double>::infinity();
};

}  // namespace microtrace
