#pragma once
/// Traces rays through trees of a few triangles without traversal: tests each triangle or
/// parallelogram against N rays at a time. Incoherent rays would enter most of the boxes of such a
/// tree anyway.

#include "accel/kernels/block_test.hpp"
#include "accel/kernels/kernel.hpp"

namespace microtrace {
namespace {

/// The number of facets up to which testing all of them is faster than traversal.
template <int N>
constexpr int kFewFacets = 4 * N;

template <int N>
inline bool has_few_triangles(const TreeView& tree) {
  return tree.few != nullptr && tree.few->ends[FewTriangles::kOblique] <= kFewFacets<N>;
}

/// Finds the nearest hits or, with kAny, any hits.
template <int N, bool kAny>
class FewTrianglesWalk {
 public:
  FewTrianglesWalk(const TreeView& tree, KernelStream& stream, const StreamFallback& slow)
      : tree_(tree), stream_(stream), slow_(slow) {}

  void run() {
    for (first_ = 0; first_ < stream_.count; first_ += N) meet_all();
  }

 private:
  using F = Float<N>;

  /// The rays that may hit a triangle.
  struct Candidates {
    Lanes maybe, certain;  ///< as in VolumeTest
    Lanes unsure = 0;      ///< lanes of `maybe` that may pass through an open front
  };
  /// The rays that are being traced, and the bounds of t of their nearest hits so far.
  struct Group {
    Lanes rays;
    F o[3], d[3], d_sum, begin, t_min, best_lo, best_hi;
    F limit;  ///< best_hi, but at most kFarthestHit
  };

  /// Updates the nearest hits of rays first_ to first_ + N - 1.
  void meet_all() {
    const int rest = stream_.count - first_;
    Group group;
    group.rays = rest < N ? (Lanes{1} << rest) - 1 : kAllLanes<N>;
    if (kAny) group.rays &= without_hit();
    for (int axis = 0; axis < 3; ++axis) {
      group.o[axis] = load<N>(stream_.o[axis] + first_);
      group.d[axis] = load<N>(stream_.d[axis] + first_);
    }
    group.d_sum = load<N>(stream_.d_sum + first_);
    group.begin = load<N>(stream_.t_begin + first_);
    group.t_min = load<N>(stream_.t_min + first_);
    load_best(group);
    const FewTriangles& few = *tree_.few;
    int i = 0;
    for (; i < few.ends[0] && group.rays != 0; ++i) meet_upright<0>(few.facets[i], group);
    for (; i < few.ends[1] && group.rays != 0; ++i) meet_upright<1>(few.facets[i], group);
    for (; i < few.ends[2] && group.rays != 0; ++i) meet_upright<2>(few.facets[i], group);
    for (; i < few.ends[FewTriangles::kOblique] && group.rays != 0; ++i) {
      const FewTriangles::Facet& facet = few.facets[i];
      meet(facet, facet.e1, facet.e2, facet.n, group);
    }
    store_best(group);
  }

  /// Returns the rays for which no hit has been found.
  [[nodiscard]] Lanes without_hit() const {
    return equal_to<N>(stream_.best_id + first_, kNoPrimitive);
  }
  void load_best(Group& group) const {
    group.best_lo = load<N>(stream_.best_lo + first_);
    group.best_hi = load<N>(stream_.best_hi + first_);
    group.limit = lesser(group.best_hi, all<N>(kFarthestHit));
  }
  void store_best(const Group& group) {
    store<N>(stream_.best_lo + first_, group.best_lo);
    store<N>(stream_.best_hi + first_, group.best_hi);
  }

  /// Meets a facet whose edges and normal are along axes. Most of the products would be zero.
  template <int kAxis>
  __attribute__((always_inline)) void meet_upright(const FewTriangles::Facet& facet, Group& group) {
    constexpr int kFirst = (kAxis + 1) % 3, kSecond = (kAxis + 2) % 3;
    meet(facet, Along<kFirst>{facet.e1[kFirst]}, Along<kSecond>{facet.e2[kSecond]},
         Along<kAxis>{facet.n[kAxis]}, group);
  }

  /// Updates the nearest hits of the rays that hit a facet.
  template <class Edge1, class Edge2, class Normal>
  __attribute__((always_inline)) void meet(const FewTriangles::Facet& facet, const Edge1& e1,
                                           const Edge2& e2, const Normal& n, Group& group) {
    const F a[3] = {facet.a[0] - group.o[0], facet.a[1] - group.o[1], facet.a[2] - group.o[2]};
    const Volumes<N, F> volumes(a, e1, e2, n, group.d, facet.largest_edge, facet.edge_product,
                                group.d_sum, kNoSlack, facet.height_slack);
    const F &u = volumes.u, &v = volumes.v, &size = volumes.size, &error = volumes.edge_error;
    const F diagonal = size - (u + v);  // the volume at the edge opposite a
    const bool is_triangle = facet.second < 0;
    const F opposite = is_triangle ? diagonal : lesser(F(size - u), F(size - v));
    const F within = lesser(lesser(u, v), opposite);
    const Lanes maybe =
        group.rays & less_equal<N>(-error, within) & volumes.in_range(group.begin, group.limit);
    if (maybe == 0) return;
    const Lanes certain = less<N>(error, within) & volumes.with_t();
    const Interval<F> t = interval(volumes.height, size, volumes.height_error, volumes.size_error);
    if (is_triangle) {
      meet(facet.first, {.maybe = maybe, .certain = certain}, t, volumes, group);
      return;
    }
    const Lanes inside = less<N>(error, diagonal), outside = less<N>(diagonal, -error);
    const Lanes unknown = volumes.without_sign();
    meet(facet.first, {.maybe = maybe & (~outside | unknown), .certain = certain & inside}, t,
         volumes, group);
    meet(facet.second, {.maybe = maybe & (~inside | unknown), .certain = certain & outside}, t,
         volumes, group);
  }

  /// Updates the nearest hits of the rays that may hit a triangle at t.
  __attribute__((always_inline)) void meet(int number, Candidates rays, const Interval<F>& t,
                                           const Volumes<N, F>& volumes, Group& group) {
    if (rays.maybe == 0) return;
    const FewTriangles::Entry& triangle = tree_.few->entries[number];
    rays.maybe &= ~equal_to<N>(stream_.omitted_id + first_, triangle.id);
    if (rays.maybe != 0 && is_open_front(tree_, triangle.id)) pass_fronts(triangle, rays);
    if (rays.maybe == 0) return;
    const Lanes nearer = rays.maybe & ~rays.unsure & rays.certain & less<N>(t.hi, group.best_lo) &
                         less_equal<N>(group.t_min, t.lo);
    const Lanes farther = rays.certain & less<N>(group.best_hi, t.lo);
    if (nearer != 0) {
      group.best_lo = select<N>(nearer, t.lo, group.best_lo);
      group.best_hi = select<N>(nearer, t.hi, group.best_hi);
      group.limit = select<N>(nearer, t.hi, group.limit);
      store_where<N>(nearer, triangle.id, stream_.best_id + first_);
      if (kAny) group.rays &= ~nearer;
    }
    rays.maybe &= ~nearer & ~farther;
    if (rays.maybe != 0) rays.maybe &= entering(triangle.box, group);
    if (rays.maybe == 0) return;
    store_best(group);
    decide(triangle, rays, t, volumes.with_t());
    load_best(group);
    if (kAny) group.rays &= without_hit();
  }

  /// Returns the rays that enter a triangle's bounding box before their nearest hits. As in a tree,
  /// few of the rays in a triangle's plane do.
  [[nodiscard]] Lanes entering(const FewTriangles::Box& box, const Group& group) const {
    F enter = group.begin, leave = group.best_hi;
    for (int axis = 0; axis < 3; ++axis) {
      const F near_factor = load<N>(stream_.near[axis] + first_),
              far_factor = load<N>(stream_.far[axis] + first_);
      const F zero{}, lo = box.lo[axis] - group.o[axis], hi = box.hi[axis] - group.o[axis];
      enter = greater(near_factor * (near_factor < zero ? hi : lo), enter);
      leave = lesser(far_factor * (far_factor < zero ? lo : hi), leave);
    }
    return less_equal<N>(enter, leave);
  }

  /// Removes the rays that pass through the front of an open triangle.
  void pass_fronts(const FewTriangles::Entry& triangle, Candidates& rays) const {
    const TriangleBlock& block = tree_.blocks[triangle.slot / kWidth];
    for (Lanes rest = rays.maybe; rest != 0; rest &= rest - 1) {
      const int lane = first_lane(rest), ray = first_ + lane;
      const float d[3] = {stream_.d[0][ray], stream_.d[1][ray], stream_.d[2][ray]};
      const Within front = meets_front(block, static_cast<int>(triangle.slot % kWidth), d);
      if (front == Within::yes) rays.maybe &= ~(Lanes{1} << lane);
      if (front == Within::unsure) rays.unsure |= Lanes{1} << lane;
    }
  }

  /// Decides the lanes that the comparison of intervals can't decide. The fallback decides those in
  /// `unsure`.
  void decide(const FewTriangles::Entry& triangle, const Candidates& rays, const Interval<F>& t,
              Lanes with_t) {
    const TriangleBlock& block = tree_.blocks[triangle.slot / kWidth];
    const int k = static_cast<int>(triangle.slot % kWidth);
    float t_lo[N], t_hi[N];
    store<N>(t_lo, t.lo);
    store<N>(t_hi, t.hi);
    for (Lanes lanes = rays.maybe; lanes != 0; lanes &= lanes - 1) {
      const int lane = first_lane(lanes), ray = first_ + lane;
      const float o[3] = {stream_.o[0][ray], stream_.o[1][ray], stream_.o[2][ray]};
      const float d[3] = {stream_.d[0][ray], stream_.d[1][ray], stream_.d[2][ray]};
      ClosestSoFar best{stream_.best_lo[ray], stream_.best_hi[ray], stream_.best_id[ray]};
      const PossibleHit hit{.t = {t_lo[lane], t_hi[lane]},
                            .is_certain = (rays.certain >> lane & 1U) != 0,
                            .has_t = (with_t >> lane & 1U) != 0};
      const auto fallback = [&](std::uint32_t id, ClosestSoFar& nearest) {
        slow_.consider(slow_.context, ray, id, nearest);
      };
      if ((rays.unsure >> lane & 1U) != 0)
        fallback(triangle.id, best);
      else
        consider(block, k, {o, d, stream_.t_min[ray]}, hit, best, fallback);
      stream_.best_lo[ray] = best.lo;
      stream_.best_hi[ray] = best.hi;
      stream_.best_id[ray] = best.id;
    }
  }

  const TreeView& tree_;
  KernelStream& stream_;
  const StreamFallback& slow_;
  int first_ = 0;
};

}  // namespace
}  // namespace microtrace
