#pragma once
/// Finds the triangles of a small tree near boxes.

#include "accel/kernels/few_triangles.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/near/box_tests.hpp"
#include "accel/kernels/simd.hpp"
#include "simd/masks.hpp"

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
      const Group group(queries_, first, rest < N ? (Lanes{1} << rest) - 1 : kAllLanes<N>);
      const int* const ends = tree_.few->ends;
      search_rectangles<0>(0, ends[0], group);
      search_rectangles<1>(ends[0], ends[1], group);
      search_rectangles<2>(ends[1], ends[2], group);
      for (int i = ends[2]; i < ends[FewTriangles::kOblique]; ++i)
        search(tree_.few->facets[i], group.all, group);
    }
  }

 private:
  using F = Float<N>;

  /// The queries that are answered together.
  struct Group {
    int first;
    Lanes all;
    F lo[3], hi[3];
    F plane_axis, plane_at;

    Group(const BoxQueries& queries, int first_query, Lanes lanes)
        : first(first_query),
          all(lanes),
          plane_axis(load<N>(queries.plane_axis + first)),
          plane_at(load<N>(queries.plane_at + first)) {
      for (int axis = 0; axis < 3; ++axis)
        lo[axis] = load<N>(queries.lo[axis] + first), hi[axis] = load<N>(queries.hi[axis] + first);
    }

    /// Returns the lanes that omit the triangles in a plane perpendicular to an axis.
    [[nodiscard]] Lanes omitting(int axis, float at) const {
      return true_lanes<N>((plane_axis == static_cast<float>(axis)) & (plane_at == at));
    }
  };

  /// Adds the rectangles from i on that are perpendicular to an axis. Most are excluded by their
  /// planes.
  template <int kAxis>
  void search_rectangles(int i, int end, const Group& group) {
    for (; i < end; ++i) {
      const FewTriangles::Facet& facet = tree_.few->facets[i];
      const F plane = all<N>(facet.rectangle.plane);
      Lanes near =
          group.all & less_equal<N>(group.lo[kAxis], plane) & less_equal<N>(plane, group.hi[kAxis]);
      if (near != 0) near &= ~group.omitting(kAxis, facet.rectangle.plane);
      if (near != 0) search(facet, near, group);
    }
  }

  /// Adds the triangles of a facet to the results of the queries in these lanes that they touch.
  void search(const FewTriangles::Facet& facet, Lanes lanes, const Group& group) {
    const Lanes near = lanes & overlapping<N>(facet.box.lo, facet.box.hi, group.lo, group.hi);
    if (near == 0) return;
    const CenteredBox<F> boxes(group.lo, group.hi);
    const int numbers[] = {facet.first, facet.second};
    for (const int number : numbers) {
      if (number < 0) break;
      const FewTriangles::Entry& triangle = tree_.few->entries[number];
      Lanes touching = near & ~equal_to<N>(queries_.omitted_id + group.first, triangle.id);
      if (triangle.plane_axis >= 0)
        touching &= ~group.omitting(triangle.plane_axis, triangle.plane_at);
      if (touching != 0 && facet.second >= 0)
        touching &= overlapping<N>(triangle.box.lo, triangle.box.hi, group.lo, group.hi);
      if (touching != 0) touching = without_clear<N>(touching, triangle.vertices, boxes);
      for (; touching != 0; touching &= touching - 1) {
        const int i = group.first + first_lane(touching);
        if (queries_.count[i] >= 0) adds_too_many(queries_, i, triangle.slot);
      }
    }
  }

  const TreeView& tree_;
  BoxQueries& queries_;
};

}  // namespace
}  // namespace microtrace
