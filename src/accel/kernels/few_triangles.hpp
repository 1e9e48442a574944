#pragma once
/// Traces rays through trees of a few triangles without traversal: tests each triangle or
/// parallelogram against N rays at a time. Incoherent rays would enter most of the boxes of such a
/// tree anyway.

#include "accel/kernels/block_test.hpp"
#include "accel/kernels/entering_rays.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/rectangle_test.hpp"

namespace microtrace {
namespace {

/// The number of facets up to which testing all of them is faster than traversal.
template <int N>
constexpr int kFewFacets = 4 * N;

template <int N>
inline bool has_few_triangles(const TreeView& tree) {
  return tree.few != nullptr &&
         (!tree.few_are_all || tree.few->ends[FewTriangles::kOblique] <= kFewFacets<N>);
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
    Lanes unsure = 0;      ///< lanes of `maybe` that may pass through an open side
  };
  /// The rays that may hit a facet.
  struct FacetHits {
    Lanes maybe, certain;  ///< as in VolumeTest
    Lanes first, second;   ///< lanes that certainly don't hit the other triangle
    Lanes with_t;          ///< lanes in which t is valid
    Interval<F> t;
  };
  /// The rays that are being traced, and the bounds of t of their nearest hits so far.
  struct Group {
    RectangleRays<N> rectangle_rays;
    Lanes rays;
    F d_sum, begin, t_min, best_lo, best_hi;
    F limit;  ///< best_hi, but at most kFarthestHit

    Group(const KernelStream& stream, int first)
        : rectangle_rays(stream, first),
          rays(stream.count - first < N ? (Lanes{1} << (stream.count - first)) - 1 : kAllLanes<N>),
          d_sum(load<N>(stream.d_sum + first)),
          begin(load<N>(stream.t_begin + first)),
          t_min(load<N>(stream.t_min + first)) {
      load_best(stream, first);
    }
    void load_best(const KernelStream& stream, int first) {
      best_lo = load<N>(stream.best_lo + first);
      best_hi = load<N>(stream.best_hi + first);
      limit = lesser(best_hi, all<N>(kFarthestHit));
    }
    void store_best(KernelStream& stream, int first) const {
      store<N>(stream.best_lo + first, best_lo);
      store<N>(stream.best_hi + first, best_hi);
    }
  };

  /// Updates the nearest hits of rays first_ to first_ + N - 1.
  void meet_all() {
    Group group(stream_, first_);
    if (kAny) group.rays &= without_hit();
    const FewTriangles& few = *tree_.few;
    int i = 0;
    for (; i < few.ends[0] && group.rays != 0; ++i) meet_rectangle<0>(few.facets[i], group);
    for (; i < few.ends[1] && group.rays != 0; ++i) meet_rectangle<1>(few.facets[i], group);
    for (; i < few.ends[2] && group.rays != 0; ++i) meet_rectangle<2>(few.facets[i], group);
    for (; i < few.ends[FewTriangles::kOblique] && group.rays != 0; ++i)
      meet_oblique(few.facets[i], group);
    group.store_best(stream_, first_);
  }

  /// Returns the rays for which no hit has been found.
  [[nodiscard]] Lanes without_hit() const {
    return equal_to<N>(stream_.best_id + first_, kNoPrimitive);
  }

  /// Updates the nearest hits of the rays that hit a facet.
  template <int kAxis>
  __attribute__((always_inline)) void meet_rectangle(const FewTriangles::Facet& facet,
                                                     Group& group) {
    const RectangleTest<N, kAxis> test(facet.rectangle, group.rectangle_rays);
    const Lanes maybe = group.rays & ~test.misses(group.limit);
    if (maybe == 0) return;
    const auto [first, second] = test.sides();
    meet(facet,
         {.maybe = maybe,
          .certain = test.within(),
          .first = first,
          .second = second,
          .with_t = test.with_t(),
          .t = test.t()},
         group);
  }
  __attribute__((always_inline)) void meet_oblique(const FewTriangles::Facet& facet, Group& group) {
    const RectangleRays<N>& rays = group.rectangle_rays;
    const F a[3] = {facet.a[0] - rays.o[0], facet.a[1] - rays.o[1], facet.a[2] - rays.o[2]};
    const Volumes<N, F> volumes(a, facet.e1, facet.e2, facet.n, rays.d, facet.largest_edge,
                                facet.edge_product, group.d_sum, kNoSlack, facet.height_slack);
    const F &u = volumes.u, &v = volumes.v, &size = volumes.size, &error = volumes.edge_error;
    const F diagonal = size - (u + v);  // the volume at the edge opposite a
    const F opposite = facet.second < 0 ? diagonal : lesser(F(size - u), F(size - v));
    const F within = lesser(lesser(u, v), opposite);
    const Lanes maybe =
        group.rays & less_equal<N>(-error, within) & volumes.in_range(group.begin, group.limit);
    if (maybe == 0) return;
    const Lanes with_sign = ~volumes.without_sign();
    meet(facet,
         {.maybe = maybe,
          .certain = less<N>(error, within),
          .first = less<N>(error, diagonal) & with_sign,
          .second = less<N>(diagonal, -error) & with_sign,
          .with_t = volumes.with_t(),
          .t = interval(volumes.height, size, volumes.height_error, volumes.size_error)},
         group);
  }

  /// Updates the nearest hits of the rays that may hit a facet.
  __attribute__((always_inline)) void meet(const FewTriangles::Facet& facet, const FacetHits& hits,
                                           Group& group) {
    const bool is_pair = facet.second >= 0;
    const std::uint32_t first_id = tree_.few->entries[facet.first].id,
                        second_id = is_pair ? tree_.few->entries[facet.second].id : first_id;
    const std::uint32_t* const omitted_id = stream_.omitted_id + first_;
    Lanes first = hits.maybe & ~hits.second & ~equal_to<N>(omitted_id, first_id);
    Lanes second = is_pair ? hits.maybe & ~hits.first & ~equal_to<N>(omitted_id, second_id) : 0;
    if ((first | second) == 0) return;
    if (tree_.open.triangles == nullptr && !is_masked(tree_, first_id) &&
        !is_masked(tree_, second_id)) {
      const Lanes certain = certain_of(hits) & (first | second);
      const Lanes nearer =
          certain & less<N>(hits.t.hi, group.best_lo) & less_equal<N>(group.t_min, hits.t.lo);
      const Lanes decided = nearer | (certain & less<N>(group.best_hi, hits.t.lo));
      if (nearer != 0) {
        group.best_lo = select<N>(nearer, hits.t.lo, group.best_lo);
        group.best_hi = select<N>(nearer, hits.t.hi, group.best_hi);
        group.limit = select<N>(nearer, hits.t.hi, group.limit);
        store_where<N>(nearer & first, first_id, stream_.best_id + first_);
        store_where<N>(nearer & second, second_id, stream_.best_id + first_);
        if (kAny) group.rays &= ~nearer;
      }
      first &= ~decided;
      second &= ~decided;
      if ((first | second) == 0) return;
    }
    meet_slowly(facet.first, first, hits, group);
    if (second != 0) meet_slowly(facet.second, second, hits, group);
  }

  /// Returns the lanes that certainly hit one of a facet's triangles, or miss its only one.
  [[nodiscard]] static Lanes certain_of(const FacetHits& hits) {
    return hits.certain & hits.with_t & (hits.first | hits.second);
  }

  /// Updates the nearest hits of the rays that may hit a triangle, each by itself.
  __attribute__((noinline)) void meet_slowly(int number, Lanes maybe, const FacetHits& hits,
                                             Group& group) {
    const FewTriangles::Entry& triangle = tree_.few->entries[number];
    Candidates rays{.maybe = maybe, .certain = certain_of(hits)};
    if (rays.maybe != 0 && is_open(tree_, triangle.id)) pass_open_sides(triangle, rays);
    // As in a tree, few of the rays in a triangle's plane enter its box before their nearest hits.
    if (rays.maybe != 0)
      rays.maybe &= rays_entering<N>(stream_, first_, triangle.box, group.best_hi);
    if (rays.maybe == 0) return;
    group.store_best(stream_, first_);
    decide(triangle, rays, hits.t, hits.with_t);
    group.load_best(stream_, first_);
    if (kAny) group.rays &= without_hit();
  }

  /// Removes the rays that pass through the open side of a triangle.
  void pass_open_sides(const FewTriangles::Entry& triangle, Candidates& rays) const {
    const TriangleBlock& block = tree_.blocks[triangle.slot / kWidth];
    for (Lanes rest = rays.maybe; rest != 0; rest &= rest - 1) {
      const int lane = first_lane(rest), ray = first_ + lane;
      const float d[3] = {stream_.d[0][ray], stream_.d[1][ray], stream_.d[2][ray]};
      const int k = static_cast<int>(triangle.slot % kWidth);
      const Within passes = meets_open_side(tree_, block, k, d);
      if (passes == Within::yes) rays.maybe &= ~(Lanes{1} << lane);
      if (passes == Within::unsure) rays.unsure |= Lanes{1} << lane;
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
      const StreamRayFallback fallback{slow_, ray};
      if ((rays.unsure >> lane & 1U) != 0)
        fallback(triangle.id, best);
      else
        consider(tree_, block, k, {o, d, stream_.t_min[ray]}, hit, best, fallback);
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
