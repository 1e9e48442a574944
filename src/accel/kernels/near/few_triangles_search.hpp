#pragma once
/// Finds the triangles of a small tree near boxes.

#include "accel/kernels/few_triangles.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/near/box_tests.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

/// Finds the triangles near up to kBoxQueries boxes, by tests of one triangle against N boxes.
template <int N>
class FewTrianglesSearch {
 public:
  FewTrianglesSearch(const TreeView& tree, BoxQueries& queries) : tree_(tree), queries_(queries) {}

  void run() {
    for (int first = 0; first < queries_.size; first += N) {
      const int rest = queries_.size - first;
      const Lanes all_queries = rest < N ? (Lanes{1} << rest) - 1 : kAllLanes<N>;
      F lo[3], hi[3];
      for (int axis = 0; axis < 3; ++axis)
        lo[axis] = load<N>(queries_.lo[axis] + first),
        hi[axis] = load<N>(queries_.hi[axis] + first);
      const CenteredBox<F> boxes(lo, hi);
      for (int k = 0; k < tree_.few->ends[FewTriangles::kOblique]; ++k) {
        const FewTriangles::Facet& facet = tree_.few->facets[k];
        const Lanes near = all_queries & overlapping<N>(facet.box.lo, facet.box.hi, lo, hi);
        if (near == 0) continue;
        const int numbers[] = {facet.first, facet.second};
        for (const int number : numbers) {
          if (number < 0) break;
          const FewTriangles::Entry& triangle = tree_.few->entries[number];
          Lanes lanes = without_omitted(triangle, first, near);
          if (lanes != 0 && facet.second >= 0)
            lanes &= overlapping<N>(triangle.box.lo, triangle.box.hi, lo, hi);
          if (lanes != 0) lanes = without_clear<N>(lanes, triangle.vertices, boxes);
          for (; lanes != 0; lanes &= lanes - 1) {
            const int i = first + first_lane(lanes);
            if (queries_.count[i] >= 0) adds_too_many(queries_, i, triangle.slot);
          }
        }
      }
    }
  }

 private:
  using F = Float<N>;

  /// Returns those of `lanes` whose queries don't omit the triangle.
  [[nodiscard]] Lanes without_omitted(const FewTriangles::Entry& triangle, int first,
                                      Lanes lanes) const {
    lanes &= ~equal_to<N>(queries_.omitted_id + first, triangle.id);
    if (triangle.plane_axis < 0) return lanes;
    const F at = load<N>(queries_.plane_at + first), own = all<N>(triangle.plane_at);
    const F axes = load<N>(queries_.plane_axis + first);
    const F axis = all<N>(static_cast<float>(triangle.plane_axis));
    return lanes & ~(less_equal<N>(axes, axis) & less_equal<N>(axis, axes) &
                     less_equal<N>(at, own) & less_equal<N>(own, at));
  }

  const TreeView& tree_;
  BoxQueries& queries_;
};

}  // namespace
}  // namespace microtrace
