#pragma once
/// Traces rays through trees of a few triangles without traversal: tests each triangle against N
/// rays at a time. Incoherent rays would enter most of the boxes of such a tree anyway.

#include "accel/kernels/block_test.hpp"
#include "accel/kernels/kernel.hpp"

namespace microtrace {
namespace {

/// The number of triangles up to which testing all of them is faster than traversal.
template <int N>
constexpr int kFewTriangles = 3 * N;

template <int N>
inline bool has_few_triangles(const TreeView& tree) {
  return tree.few != nullptr && tree.few->count <= kFewTriangles<N>;
}

template <int N>
class FewTrianglesWalk {
 public:
  FewTrianglesWalk(const TreeView& tree, KernelStream& stream, const StreamFallback& slow)
      : tree_(tree), stream_(stream), slow_(slow) {}

  void run() {
    for (first_ = 0; first_ < stream_.count; first_ += N) meet_all();
  }

 private:
  using F = Float<N>;

  /// Updates the nearest hits of rays first_ to first_ + N - 1.
  void meet_all() {
    const int rest = stream_.count - first_;
    const Lanes rays = rest < N ? (Lanes{1} << rest) - 1 : kAllLanes<N>;
    F o[3], d[3];
    for (int axis = 0; axis < 3; ++axis) {
      o[axis] = load<N>(stream_.o[axis] + first_);
      d[axis] = load<N>(stream_.d[axis] + first_);
    }
    const F begin = load<N>(stream_.t_begin + first_), t_min = load<N>(stream_.t_min + first_);
    const F d_sum = load<N>(stream_.d_sum + first_);
    const bool has_open = tree_.open_fronts != nullptr;
    F best_lo = load<N>(stream_.best_lo + first_), best_hi = load<N>(stream_.best_hi + first_);
    for (int i = 0; i < tree_.few->count; ++i) {
      const FewTriangles::Entry& triangle = tree_.few->entries[i];
      const float(&vertex)[3] = triangle.vertices[0];
      const F a[3] = {vertex[0] - o[0], vertex[1] - o[1], vertex[2] - o[2]};
      const F limit = lesser(best_hi, all<N>(kFarthestHit));
      const VolumeTest<N, F> test(a, triangle.e1, triangle.e2, triangle.n, d, triangle.largest_edge,
                                  triangle.edge_product, d_sum, begin, limit);
      Lanes maybe = test.maybe & rays;
      if (maybe != 0) maybe &= ~equal_to<N>(stream_.omitted_id + first_, triangle.id);
      Lanes unsure = 0;
      if (maybe != 0 && has_open && is_open_front(tree_, triangle.id))
        pass_fronts(triangle, maybe, unsure);
      if (maybe == 0) continue;
      const Interval<F> t = interval(test.height, test.size, test.height_error, test.size_error);
      const Lanes nearer =
          maybe & ~unsure & test.certain & less<N>(t.hi, best_lo) & less_equal<N>(t_min, t.lo);
      const Lanes farther = test.certain & less<N>(best_hi, t.lo);
      if (nearer != 0) {
        best_lo = select<N>(nearer, t.lo, best_lo);
        best_hi = select<N>(nearer, t.hi, best_hi);
        store_where<N>(nearer, triangle.id, stream_.best_id + first_);
      }
      Lanes open = maybe & ~nearer & ~farther;
      if (open != 0) open &= entering(triangle, o, begin, best_hi);
      if (open == 0) continue;
      store<N>(stream_.best_lo + first_, best_lo);
      store<N>(stream_.best_hi + first_, best_hi);
      decide(triangle, test, t, open, unsure);
      best_lo = load<N>(stream_.best_lo + first_);
      best_hi = load<N>(stream_.best_hi + first_);
    }
    store<N>(stream_.best_lo + first_, best_lo);
    store<N>(stream_.best_hi + first_, best_hi);
  }

  /// Returns the rays that enter the triangle's bounding box before `limit`. As in a tree, few of
  /// the rays in a triangle's plane do.
  [[nodiscard]] Lanes entering(const FewTriangles::Entry& triangle, const F (&o)[3], const F& begin,
                               const F& limit) const {
    F enter = begin, leave = limit;
    for (int axis = 0; axis < 3; ++axis) {
      const F near_factor = load<N>(stream_.near[axis] + first_),
              far_factor = load<N>(stream_.far[axis] + first_);
      const F zero{}, lo = triangle.lo[axis] - o[axis], hi = triangle.hi[axis] - o[axis];
      enter = greater(near_factor * (near_factor < zero ? hi : lo), enter);
      leave = lesser(far_factor * (far_factor < zero ? lo : hi), leave);
    }
    return less_equal<N>(enter, leave);
  }

  /// Removes the lanes whose rays pass through the front of an open triangle. Adds those of which
  /// this is unsure to `unsure`.
  void pass_fronts(const FewTriangles::Entry& triangle, Lanes& lanes, Lanes& unsure) const {
    const TriangleBlock& block = tree_.blocks[triangle.slot / kWidth];
    for (Lanes rest = lanes; rest != 0; rest &= rest - 1) {
      const int lane = first_lane(rest), ray = first_ + lane;
      const float d[3] = {stream_.d[0][ray], stream_.d[1][ray], stream_.d[2][ray]};
      const Within front = meets_front(block, static_cast<int>(triangle.slot % kWidth), d);
      if (front == Within::yes) lanes &= ~(Lanes{1} << lane);
      if (front == Within::unsure) unsure |= Lanes{1} << lane;
    }
  }

  /// Decides the lanes that the comparison of intervals can't decide. The fallback decides those in
  /// `unsure`.
  void decide(const FewTriangles::Entry& triangle, const VolumeTest<N, F>& test,
              const Interval<F>& t, Lanes lanes, Lanes unsure) {
    const TriangleBlock& block = tree_.blocks[triangle.slot / kWidth];
    const int k = static_cast<int>(triangle.slot % kWidth);
    const Lanes has_t = less<N>(16 * test.size_error, test.size);
    float t_lo[N], t_hi[N];
    store<N>(t_lo, t.lo);
    store<N>(t_hi, t.hi);
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = first_lane(lanes), ray = first_ + lane;
      const float o[3] = {stream_.o[0][ray], stream_.o[1][ray], stream_.o[2][ray]};
      const float d[3] = {stream_.d[0][ray], stream_.d[1][ray], stream_.d[2][ray]};
      ClosestSoFar best{stream_.best_lo[ray], stream_.best_hi[ray], stream_.best_id[ray]};
      const PossibleHit hit{.t = {t_lo[lane], t_hi[lane]},
                            .is_certain = (test.certain >> lane & 1U) != 0,
                            .has_t = (has_t >> lane & 1U) != 0};
      const auto fallback = [&](std::uint32_t id, ClosestSoFar& nearest) {
        slow_.consider(slow_.context, ray, id, nearest);
      };
      if ((unsure >> lane & 1U) != 0)
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
