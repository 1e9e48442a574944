#pragma once
/// Finds the rays of a stream that enter a box.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

/// An item of remaining work: a ray and a subtree that it must visit.
struct StreamItem {
  int ray;
  ChildRef child;
};

/// The remaining work of all packets. If this array is full, the packets do the work themselves.
struct StreamItems {
  static constexpr int kCapacity = 4 * kStreamRays;
  int size = 0;
  StreamItem item[kCapacity];
};

/// Returns the rays from `first` on that enter a box at most at t_limit.
template <int N>
inline Lanes rays_entering(const KernelStream& stream, int first, const FewTriangles::Box& box,
                           const Float<N>& t_limit) {
  using F = Float<N>;
  F enter = load<N>(stream.t_begin + first), leave = t_limit;
  for (int axis = 0; axis < 3; ++axis) {
    const F o = load<N>(stream.o[axis] + first), near_factor = load<N>(stream.near[axis] + first),
            far_factor = load<N>(stream.far[axis] + first);
    const F zero{}, lo = box.lo[axis] - o, hi = box.hi[axis] - o;
    enter = greater(near_factor * (near_factor < zero ? hi : lo), enter);
    leave = lesser(far_factor * (far_factor < zero ? lo : hi), leave);
  }
  return less_equal<N>(enter, leave);
}

/// Lists the rays that enter TreeView::rest before their nearest hits.
template <int M>
inline void list_entering(const TreeView& tree, const KernelStream& stream, StreamItems& items) {
  for (int first = 0; first < stream.count; first += M) {
    const int rest = stream.count - first;
    Lanes lanes = rays_entering<M>(stream, first, tree.rest, load<M>(stream.best_hi + first));
    if (rest < M) lanes &= (Lanes{1} << rest) - 1;
    for (; lanes != 0; lanes &= lanes - 1)
      items.item[items.size++] = {first + first_lane(lanes), tree.root};
  }
}

}  // namespace
}  // namespace microtrace
