#pragma once
/// Answers any-hit queries for rays with nearby origins. 64 rays traverse the tree together, and
/// the stack holds the set of rays that enter each subtree. Boxes and triangles are tested against
/// N rays at a time. Once few rays are left in a subtree, the traversal of stream.hpp takes over.

#include "accel/kernels/block_test.hpp"
#include "accel/kernels/entering_rays.hpp"
#include "accel/kernels/node_test.hpp"
#include "accel/kernels/single_ray.hpp"
#include "accel/kernels/slabs.hpp"

namespace microtrace {
namespace {

template <int N>
class OcclusionPacketWalk {
 public:
  static constexpr int kRays = kPacketRays;

  OcclusionPacketWalk(const TreeView& tree, KernelStream& stream, const StreamFallback& slow,
                      StreamItems& items)
      : tree_(tree), stream_(stream), slow_(slow), items_(items) {}

  /// Traces the packet of rays that starts at ray `first`, which must be a multiple of kRays.
  void run(int first) {
    first_ = first;
    open_ = 0;
    for (int i = 0; i < kRays && first + i < stream_.count; ++i)
      open_ |= std::uint64_t{stream_.best_id[first + i] == kNoPrimitive} << i;
    bound_segments();
    int top = 0;
    stack_[top++] = {tree_.root, open_};
    while (top > 0) {
      const Entry entry = stack_[--top];
      const std::uint64_t rays = entry.rays & open_;
      const int count = __builtin_popcountll(rays);
      if ((count < kFew || is_instance(entry.child)) &&
          items_.size + count <= StreamItems::kCapacity)
        leave_over(entry.child, rays);
      else if ((entry.child & child_ref::kKind) == 0)
        top = push_children(tree_.nodes[entry.child], rays, top);
      else
        meet_leaf(entry.child, rays);
    }
  }

 private:
  using F = Float<N>;
  static constexpr int kFew = 10;  // fewer rays than this are traced faster one by one
  static constexpr int kNodeLanes = N < kWidth ? N : kWidth;
  using B = Float<kNodeLanes>;

  struct Entry {
    ChildRef child;
    std::uint64_t rays;
  };

  // Computes a box around all segments from o to o + t_max d. The rounded end has an error of at
  // most u |t_max d| + u |o + t_max d|. Half of the margin would suffice: a plane that the exact
  // end reaches is a float32 number. The rounding of the sum therefore moves the end past the plane
  // by no more than the rounding of the product did. The margin's own rounding doesn't undo this.
  // If t_max is infinite and d is 0, the product is NaN, which lesser and greater ignore.
  void bound_segments() {
    const F unit = all<N>(4 * kUnit), infinity = all<N>(__builtin_inff());
    for (int axis = 0; axis < 3; ++axis) {
      F lo = infinity, hi = -infinity;
      for (int i = 0; i < kRays; i += N) {
        const F o = load<N>(stream_.o[axis] + first_ + i);
        const F way = load<N>(stream_.best_hi + first_ + i) * load<N>(stream_.d[axis] + first_ + i);
        const F margin = unit * (magnitude(o) + magnitude(way)) + kTiny, end = o + way;
        lo = lesser(lesser(end - margin, o), lo);
        hi = greater(greater(end + margin, o), hi);
      }
      lo_[axis] = least_of<N>(lo);
      hi_[axis] = greatest_of<N>(hi);
    }
  }

  // Returns the children that overlap the box around all rays.
  [[nodiscard]] Lanes touched(const WideNode& node) const {
    Lanes lanes = 0;
    for (int i = 0; i < kWidth; i += kNodeLanes) {
      constexpr int kM = kNodeLanes;
      const auto touches = [&](const float* lo, const float* hi, int axis) {
        return less_equal<kM>(load<kM>(lo + i), all<kM>(hi_[axis])) &
               less_equal<kM>(all<kM>(lo_[axis]), load<kM>(hi + i));
      };
      lanes |= (touches(node.lo_x, node.hi_x, 0) & touches(node.lo_y, node.hi_y, 1) &
                touches(node.lo_z, node.hi_z, 2))
               << i;
    }
    return lanes;
  }

  // Calls f(i, lanes) for each group of N rays, starting at ray i, that has rays in the set;
  // `lanes` are these rays.
  template <class Visit>
  void for_each_lanes(std::uint64_t rays, const Visit& f) const {
    for (int i = 0; i < kRays; i += N) {
      const Lanes lanes = static_cast<Lanes>(rays >> i) & kAllLanes<N>;
      if (lanes != 0) f(i, lanes);
    }
  }

  int push_children(const WideNode& node, std::uint64_t rays, int top) {
    const Lanes candidates = touched(node);
    std::uint64_t entering[kWidth] = {};
    for_each_lanes(rays, [&](int i, Lanes lanes) {
      const int at = first_ + i;
      F o[3], near[3], far[3];
      for (int axis = 0; axis < 3; ++axis) {
        o[axis] = load<N>(stream_.o[axis] + at);
        near[axis] = load<N>(stream_.near[axis] + at);
        far[axis] = load<N>(stream_.far[axis] + at);
      }
      const F begin = load<N>(stream_.t_begin + at), end = load<N>(stream_.best_hi + at);
      for (Lanes rest = candidates; rest != 0; rest &= rest - 1) {
        const int k = first_lane(rest);
        const float lo[3] = {node.lo_x[k], node.lo_y[k], node.lo_z[k]};
        const float hi[3] = {node.hi_x[k], node.hi_y[k], node.hi_z[k]};
        F enter = begin, leave = end;
        for (int axis = 0; axis < 3; ++axis) {
          const F zero{}, l = all<N>(lo[axis]), h = all<N>(hi[axis]);
          const F near_plane = near[axis] < zero ? h : l, far_plane = near[axis] < zero ? l : h;
          // greater and lesser ignore a NaN in their first argument, as in NodeTest.
          enter = greater((near_plane - o[axis]) * near[axis], enter);
          leave = lesser((far_plane - o[axis]) * far[axis], leave);
        }
        entering[k] |= std::uint64_t{less_equal<N>(enter, leave) & lanes} << i;
      }
    });
    for (Lanes rest = candidates; rest != 0; rest &= rest - 1) {
      const int k = first_lane(rest);
      stack_[top] = {node.child[k], entering[k]};
      top += entering[k] != 0;
    }
    return top;
  }

  void leave_over(ChildRef child, std::uint64_t rays) {
    for (; rays != 0; rays &= rays - 1)
      items_.item[items_.size++] = {first_ + first_lane(rays), child};
  }

  // Traces the rays through an instance one by one, if the array of remaining work is full.
  void meet_instance(ChildRef instance, std::uint64_t rays) {
    TreeView tree = tree_;
    tree.root = instance;
    for (; rays != 0; rays &= rays - 1) {
      const int ray = first_lane(rays), at = first_ + ray;
      KernelRay single{};
      for (int axis = 0; axis < 3; ++axis) {
        single.o[axis] = stream_.o[axis][at];
        single.d[axis] = stream_.d[axis][at];
      }
      single.t_min = stream_.t_min[at];
      single.t_begin = stream_.t_begin[at];
      single.omitted_id = stream_.omitted_id[at];
      ClosestSoFar best{stream_.best_lo[at], stream_.best_hi[at], kNoPrimitive};
      walk<kNodeLanes, true>(tree, single, StreamRayFallback{slow_, at}, best);
      if (best.id != kNoPrimitive) close(best.id, std::uint64_t{1} << ray);
    }
  }

  void meet_leaf(ChildRef leaf, std::uint64_t rays) {
    if (is_instance(leaf)) return meet_instance(leaf, rays & open_);
    const bool has_triangles = (leaf & child_ref::kKind) == child_ref::kTriangles;
    for_each_entry(leaf, [&](std::uint32_t entry) {
      if (has_triangles)
        meet_block(tree_.blocks[entry], rays & open_);
      else
        decide_by_fallback(tree_.others[entry], rays & open_);
      return false;
    });
  }

  void meet_block(const TriangleBlock& block, std::uint64_t rays) {
    const BlockEdges<kNodeLanes> edges(block);
    for_each_lanes(rays, [&](int i, Lanes lanes) {
      const int at = first_ + i;
      F o[3], d[3];
      for (int axis = 0; axis < 3; ++axis) {
        o[axis] = load<N>(stream_.o[axis] + at);
        d[axis] = load<N>(stream_.d[axis] + at);
      }
      const F begin = load<N>(stream_.t_begin + at), t_max = load<N>(stream_.best_hi + at);
      const F limit = lesser(t_max, all<N>(kFarthestHit)), d_sum = load<N>(stream_.d_sum + at);
      for (int k = 0; k < kWidth; ++k) {
        const float x = edges.a[0][k];
        if (!(x == x)) break;  // unused slots of the block have NaN
        const F a[3] = {x - o[0], edges.a[1][k] - o[1], edges.a[2][k] - o[2]};
        const float e1[3] = {edges.e1[0][k], edges.e1[1][k], edges.e1[2][k]};
        const float e2[3] = {edges.e2[0][k], edges.e2[1][k], edges.e2[2][k]};
        const VolumeTest<N, F> test(a, e1, e2, d, block.largest_edge, block.edge_product, d_sum,
                                    begin, limit);
        Lanes maybe = test.maybe & lanes;
        if (maybe != 0) maybe &= ~equal_to<N>(stream_.omitted_id + at, block.id[k]);
        if (maybe != 0 && is_open(tree_, block.id[k])) maybe &= not_passing(block, k, at, maybe);
        if (maybe == 0) continue;
        const Interval<F> t = interval(test.height, test.size, test.height_error, test.size_error);
        const Lanes before = less<N>(t.hi, t_max), after = less<N>(t_max, t.lo);
        const Lanes begun = less_equal<N>(load<N>(stream_.t_min + at), t.lo);
        Lanes hit = maybe & test.certain & before & begun;
        if (is_masked(tree_, block.id[k])) {
          const SeenLanes seen = seen_lanes(block, k, at, hit);
          maybe &= ~seen.hidden;
          hit = seen.visible;
        }
        close(block.id[k], std::uint64_t{hit} << i);
        const Lanes open = maybe & ~hit & ~(test.certain & after);
        if (open != 0) decide(block, k, std::uint64_t{open} << i);
        lanes &= static_cast<Lanes>(open_ >> i);
        if (lanes == 0) break;
      }
    });
  }

  // Returns those of the given rays, starting at ray `at`, that don't arrive at the open side of a
  // triangle.
  // Rays whose side is uncertain are decided by the fallback.
  Lanes not_passing(const TriangleBlock& block, int k, int at, Lanes rays) {
    Lanes closed = 0;
    std::uint64_t unsure = 0;
    for (; rays != 0; rays &= rays - 1) {
      const int ray = at + first_lane(rays);
      const float d[3] = {stream_.d[0][ray], stream_.d[1][ray], stream_.d[2][ray]};
      const Within passes = meets_open_side(tree_, block, k, d);
      if (passes == Within::no) closed |= rays & (~rays + 1);
      if (passes == Within::unsure) unsure |= std::uint64_t{1} << (ray - first_);
    }
    decide_by_fallback(block.id[k], unsure);
    return closed;
  }

  // The lanes in which a masked triangle is visible, and those in which it isn't.
  struct SeenLanes {
    Lanes visible, hidden;
  };
  // Decides for rays, starting at ray `at`, that certainly hit a masked triangle. The fallback must
  // decide in lanes that aren't returned.
  SeenLanes seen_lanes(const TriangleBlock& block, int k, int at, Lanes rays) const {
    SeenLanes seen{};
    for (; rays != 0; rays &= rays - 1) {
      const int ray = at + first_lane(rays);
      const float o[3] = {stream_.o[0][ray], stream_.o[1][ray], stream_.o[2][ray]};
      const float d[3] = {stream_.d[0][ray], stream_.d[1][ray], stream_.d[2][ray]};
      const Visible visible =
          slow_.visible(slow_.context, ray, block.id[k], weights_at_hit(block, k, o, d));
      const Lanes lane = rays & (~rays + 1);
      seen.visible |= visible == Visible::yes ? lane : 0;
      seen.hidden |= visible == Visible::no ? lane : 0;
    }
    return seen;
  }

  // Decides hits that float32 can't decide, mostly of triangles that the rays have just left.
  void decide(const TriangleBlock& block, int k, std::uint64_t rays) {
    std::uint64_t rest = 0;
    for (; rays != 0; rays &= rays - 1) {
      const int at = first_ + first_lane(rays);
      const float o[3] = {stream_.o[0][at], stream_.o[1][at], stream_.o[2][at]};
      const float d[3] = {stream_.d[0][at], stream_.d[1][at], stream_.d[2][at]};
      if (!is_left_behind(block, k, o, d) && within_edges(block, k, o, d) != Within::no)
        rest |= rays & -rays;
    }
    decide_by_fallback(block.id[k], rest);
  }

  void close(std::uint32_t id, std::uint64_t rays) {
    open_ &= ~rays;
    for (; rays != 0; rays &= rays - 1) stream_.best_id[first_ + first_lane(rays)] = id;
  }

  void decide_by_fallback(std::uint32_t id, std::uint64_t rays) {
    for (; rays != 0; rays &= rays - 1) {
      const int ray = first_lane(rays), at = first_ + ray;
      ClosestSoFar best{stream_.best_lo[at], stream_.best_hi[at], kNoPrimitive};
      slow_.consider(slow_.context, at, id, best);
      if (best.id != kNoPrimitive) close(best.id, std::uint64_t{1} << ray);
    }
  }

  const TreeView& tree_;
  KernelStream& stream_;
  const StreamFallback& slow_;
  StreamItems& items_;
  int first_ = 0;
  std::uint64_t open_ = 0;  // rays without a hit so far
  float lo_[3], hi_[3];
  Entry stack_[kStackSize + kWidth];
};

}  // namespace
}  // namespace microtrace
