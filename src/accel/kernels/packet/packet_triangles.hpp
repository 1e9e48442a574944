#pragma once
/// Tests triangles against the rays of a packet. Terms that depend only on the common origin are
/// computed once per triangle, so each ray takes only three dot products.

#include "accel/kernels/edge_test.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/packet/packet_boxes.hpp"
#include "accel/kernels/packet/packet_view.hpp"
#include "accel/kernels/simd.hpp"
#include "accel/kernels/single_ray.hpp"

namespace microtrace {
namespace {

template <int N>
class PacketTriangles {
 public:
  PacketTriangles(const OpenSide& open, KernelPacket& packet, const PacketFallback& slow)
      : open_(open), packet_(packet), slow_(slow) {}

  /// Updates the nearest hits of these groups' rays.
  void meet(const TriangleBlock& block, Groups groups) {
    forget_indices();
    PacketView<kViewLanes> view(block, packet_, groups);
    if (open_.triangles != nullptr) pass_open_sides(block, groups, view);
    for_each_group(groups, [&](int group) {
      if (view.seen[group] == 0) return;
      const int first = group * kGroupRays;
      for (int i = first; i < first + kGroupRays; i += N) meet_triangles(view, group, i, block);
    });
  }

 private:
  using F = Float<N>;
  static constexpr int kViewLanes = N < kWidth ? N : kWidth;

  // Removes the triangles of which the rays, which have a common origin, arrive at the open side.
  // Where the side is uncertain, so is whether t is positive, and the fallback decides.
  void pass_open_sides(const TriangleBlock& block, Groups groups, PacketView<kViewLanes>& view) {
    Lanes seen = 0, open = 0;
    for_each_group(groups, [&](int group) { seen |= view.seen[group]; });
    for (Lanes lanes = seen; lanes != 0; lanes &= lanes - 1) {
      const int k = first_lane(lanes);
      open |= Lanes{is_in(open_.triangles, block.id[k])} << k;
    }
    const Lanes passed = open & (open_.is_back ? view.backs : view.fronts);
    for_each_group(groups, [&](int group) { view.seen[group] &= ~passed; });
  }

  // Tests the triangles that are not culled for this group of rays against the rays [i, i + N).
  void meet_triangles(const PacketView<kViewLanes>& view, int group, int i,
                      const TriangleBlock& block) {
    const F dx = load<N>(packet_.d[0] + i), dy = load<N>(packet_.d[1] + i),
            dz = load<N>(packet_.d[2] + i);
    for (Lanes lanes = view.seen[group]; lanes != 0; lanes &= lanes - 1) {
      const int k = first_lane(lanes);
      F size = dx * view.n[0][k] + dy * view.n[1][k] + dz * view.n[2][k];
      F u = dx * view.u[0][k] + dy * view.u[1][k] + dz * view.u[2][k];
      F v = dx * view.v[0][k] + dy * view.v[1][k] + dz * view.v[2][k];
      F height = all<N>(view.height[k]);
      if ((view.two_sided >> k & 1U) != 0) {
        u = with_sign_of<N>(u, size);
        v = with_sign_of<N>(v, size);
        height = with_sign_of<N>(height, size);
        size = magnitude(size);
      }
      const F within = lesser(lesser(u, v), size - (u + v));
      const Lanes maybe = less_equal<N>(all<N>(-view.error[k]), within);
      if (maybe != 0) {
        const Lanes certain = less<N>(all<N>(view.error[k]), within);
        meet_hits({.height = height,
                   .size = size,
                   .height_error = view.height_error[k],
                   .size_error = view.size_error[k]},
                  maybe, certain, i, {block, k});
      }
    }
  }

  struct Quotient {
    F height, size;  // t = height / size
    float height_error, size_error;
  };
  struct Candidate {
    const TriangleBlock& block;
    int lane;
  };

  // Processes the rays [i, i + N) and one triangle. Rays in `maybe` may pass inside its edges; rays
  // in `certain` certainly do.
  void meet_hits(const Quotient& q, Lanes maybe, Lanes certain, int i, const Candidate& triangle) {
    const F best_lo = load<N>(packet_.best_lo + i), best_hi = load<N>(packet_.best_hi + i);
    const F t_begin = load<N>(packet_.t_begin + i);
    const F limit = lesser(best_hi, all<N>(kFarthestHit));
    maybe &= less_equal<N>(q.height - q.size * limit, limit * q.size_error + q.height_error);
    maybe &= less_equal<N>(q.size * t_begin - q.height, t_begin * q.size_error + q.height_error) |
             less_equal<N>(q.size, all<N>(q.size_error));
    if (maybe == 0) return;

    certain &= maybe;
    if (certain != maybe) look_at_edges(maybe, certain, i, triangle);
    const auto [lo, hi] = interval(q.height, q.size, q.height_error, q.size_error);
    certain &= less<N>(all<N>(16 * q.size_error), q.size);
    const Lanes nearer =
        certain & less<N>(hi, best_lo) & less_equal<N>(load<N>(packet_.t_min + i), lo);
    const Lanes farther = certain & less<N>(best_hi, lo);
    const std::uint32_t id = triangle.block.id[triangle.lane];
    if (nearer != 0) {
      store<N>(packet_.best_lo + i, select<N>(nearer, lo, best_lo));
      store<N>(packet_.best_hi + i, select<N>(nearer, hi, best_hi));
      store_where<N>(nearer, id, packet_.best_id + i);
      store_where<N>(nearer, index_of(triangle), packet_.best_index + i);
    }
    for (Lanes lanes = maybe & ~nearer & ~farther; lanes != 0; lanes &= lanes - 1) {
      const int ray = i + first_lane(lanes);
      // A triangle with references in several leaves is tested more than once.
      if (packet_.best_id[ray] != id) decide_by_fallback(ray, id, triangle);
    }
  }

  // Decides uncertain lanes in float64 if possible: adds them to `certain` or removes them from
  // `maybe`.
  void look_at_edges(Lanes& maybe, Lanes& certain, int i, const Candidate& triangle) const {
    for (Lanes lanes = maybe & ~certain; lanes != 0; lanes &= lanes - 1) {
      const int lane = first_lane(lanes), ray = i + lane;
      const float d[3] = {packet_.d[0][ray], packet_.d[1][ray], packet_.d[2][ray]};
      const Within within = within_edges(triangle.block, triangle.lane, packet_.o, d);
      if (within == Within::no) maybe &= ~(Lanes{1} << lane);
      if (within == Within::yes) certain |= Lanes{1} << lane;
    }
  }

  void decide_by_fallback(int ray, std::uint32_t id, const Candidate& triangle) {
    ClosestSoFar best{packet_.best_lo[ray], packet_.best_hi[ray], packet_.best_id[ray]};
    slow_.consider(slow_.context, ray, id, best);
    packet_.best_lo[ray] = best.lo;
    packet_.best_hi[ray] = best.hi;
    if (best.id != id) return;
    packet_.best_id[ray] = id;
    packet_.best_index[ray] = index_of(triangle);
  }

  void forget_indices() { __builtin_memset(index_, 0xff, sizeof index_); }

  // Returns the index of a triangle of the block in PacketHits, to which it is added if necessary.
  std::uint32_t index_of(const Candidate& triangle) {
    std::uint32_t& index = index_[triangle.lane];
    if (index == PacketHits::kNone) {
      if (packet_.hits.count == PacketHits::kMost) drop_farther_hits();
      index = add(triangle);
    }
    return index;
  }

  std::uint32_t add(const Candidate& triangle) {
    PacketHits& hits = packet_.hits;
    const auto slot = static_cast<std::size_t>(triangle.lane);
    for (int axis = 0; axis < 3; ++axis) {
      hits.a[axis][hits.count] = coordinate(triangle.block, 0, slot, axis);
      hits.b[axis][hits.count] = coordinate(triangle.block, 1, slot, axis);
      hits.c[axis][hits.count] = coordinate(triangle.block, 2, slot, axis);
    }
    return hits.count++;
  }

  // Removes triangles that are no ray's nearest hit.
  __attribute__((noinline)) void drop_farther_hits() {
    PacketHits& hits = packet_.hits;
    std::uint32_t to[PacketHits::kMost];
    __builtin_memset(to, 0xff, sizeof to);
    for (const std::uint32_t index : packet_.best_index) {
      if (index != PacketHits::kNone) to[index] = 0;
    }
    hits.count = 0;
    for (std::uint32_t from = 0; from < PacketHits::kMost; ++from) {
      if (to[from] == PacketHits::kNone) continue;
      for (int axis = 0; axis < 3; ++axis) {
        hits.a[axis][hits.count] = hits.a[axis][from];
        hits.b[axis][hits.count] = hits.b[axis][from];
        hits.c[axis][hits.count] = hits.c[axis][from];
      }
      to[from] = hits.count++;
    }
    for (std::uint32_t& index : packet_.best_index) {
      if (index != PacketHits::kNone) index = to[index];
    }
    forget_indices();
  }

  const OpenSide& open_;
  KernelPacket& packet_;
  const PacketFallback& slow_;
  std::uint32_t index_[kWidth];  // of the block's triangles in PacketHits, or kNone
};

}  // namespace
}  // namespace microtrace
