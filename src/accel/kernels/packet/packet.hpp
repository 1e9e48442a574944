#pragma once
/// Traverses the tree with up to 64 rays that have a common origin. A node's eight boxes are first
/// tested against the beam around all rays; each remaining box is then tested against the rays
/// until one enters it. Terms that depend only on the origin are computed once per triangle, so
/// each ray takes only three dot products.

#include "accel/kernels/edge_test.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/packet/packet_boxes.hpp"
#include "accel/kernels/packet/packet_view.hpp"
#include "accel/kernels/simd.hpp"
#include "accel/kernels/single_ray.hpp"

namespace microtrace {
namespace {

template <int N>
class PacketWalk {
 public:
  PacketWalk(const TreeView& tree, KernelPacket& packet, const PacketFallback& slow)
      : tree_(tree), packet_(packet), slow_(slow), scope_(tree) {
    update_limit();
  }

  void run() {
    StackEntry stack[kStackSize];
    int top = 0;
    stack[top++] = {tree_.root, packet_.least_t_begin};
    while (top > 0) {
      const StackEntry entry = stack[--top];
      if (entry.near > limit_) continue;
      if ((entry.child & child_ref::kKind) == 0) {
        top = push_children(scope_.nodes[entry.child], stack, top);
      } else if (entry.child == kInstanceEnd) {
        scope_ = Scope(tree_);
      } else if (is_instance(entry.child)) {
        const Instance& instance = tree_.instances[entry.child - child_ref::kFirstInstance];
        if (enter<N>(instance, packet_, inner_)) {
          scope_ = Scope(instance);
          stack[top++] = {kInstanceEnd, -__builtin_inff()};
          stack[top++] = {instance.mesh->root, entry.near};
        } else {
          for (std::uint32_t i = 0; i < instance.mesh->triangles; ++i)
            slow_.consider_all(slow_.context, instance.first_id + i, packet_);
          update_limit();
        }
      } else {
        meet_leaf(entry.child);
        update_limit();
      }
    }
  }

 private:
  using F = Float<N>;
  static constexpr int kNodeLanes = N < kWidth ? N : kWidth;
  using B = Float<kNodeLanes>;

  void update_limit() {
    F limit = load<N>(packet_.best_hi);
    for (int i = N; i < kPacketRays; i += N) limit = greater(limit, load<N>(packet_.best_hi + i));
    limit_ = greatest_of<N>(limit);
  }

  // The planes of a node's children through which the packet's rays enter and leave along an axis,
  // and the origins for them.
  struct Slab {
    const float *enter, *leave;
    float o_of_enter, o_of_leave;
  };
  [[nodiscard]] Slab slab(const WideNode& node, int axis) const {
    const float* lo = axis == 0 ? node.lo_x : axis == 1 ? node.lo_y : node.lo_z;
    const float* hi = axis == 0 ? node.hi_x : axis == 1 ? node.hi_y : node.hi_z;
    const float o_of_lo = boxes().o_of_lo[axis], o_of_hi = boxes().o_of_hi[axis];
    return boxes().negative[axis] ? Slab{hi, lo, o_of_hi, o_of_lo} : Slab{lo, hi, o_of_lo, o_of_hi};
  }

  int push_children(const WideNode& node, StackEntry* stack, int top) const {
    alignas(64) float near[kWidth];
    Lanes entered = 0;
    for (int i = 0; i < kWidth; i += kNodeLanes) {
      B enter = all<kNodeLanes>(packet_.least_t_begin), leave = all<kNodeLanes>(limit_);
      for (int axis = 0; axis < 3; ++axis) {
        if (!boxes().common_sign[axis]) continue;
        const Slab planes = slab(node, axis);
        const B in = load<kNodeLanes>(planes.enter + i) - planes.o_of_enter;
        const B out = load<kNodeLanes>(planes.leave + i) - planes.o_of_leave;
        enter =
            greater(lesser(in * boxes().least_near[axis], in * boxes().greatest_near[axis]), enter);
        leave =
            lesser(greater(out * boxes().least_far[axis], out * boxes().greatest_far[axis]), leave);
      }
      entered |= less_equal<kNodeLanes>(enter, leave) << i;
      store<kNodeLanes>(near + i, enter);
    }
    const int first = top;
    for (; entered != 0; entered &= entered - 1) {
      const int lane = first_lane(entered);
      if (!some_ray_enters<N>(packet_, boxes(), node, lane)) continue;
      const StackEntry entry{node.child[lane], near[lane]};
      fetch(entry.child);
      int slot = top++;
      for (; slot > first && stack[slot - 1].near < entry.near; --slot)
        stack[slot] = stack[slot - 1];
      stack[slot] = entry;
    }
    return top;
  }

  // Always inlined, because GCC removes calls of a function that only prefetches.
  __attribute__((always_inline)) void fetch(ChildRef child) const {
    const bool is_node = (child & child_ref::kKind) == 0;
    // Addresses are computed as integers, because the array is null if there are no triangles.
    const auto p = is_node
                       ? reinterpret_cast<std::uintptr_t>(scope_.nodes) + child * sizeof(WideNode)
                       : reinterpret_cast<std::uintptr_t>(scope_.blocks) +
                             first_entry(child) * sizeof(TriangleBlock);
    const std::uintptr_t lines = is_node ? 4 : 5;
    for (std::uintptr_t i = 0; i < lines; ++i) {
      // NOLINTNEXTLINE(performance-no-int-to-ptr): only prefetched
      __builtin_prefetch(reinterpret_cast<const void*>(p + 64 * i));
    }
  }

  void meet_leaf(ChildRef leaf) {
    if ((leaf & child_ref::kKind) == child_ref::kTriangles) {
      for_each_entry(leaf, [&](std::uint32_t i) {
        meet_block(i);
        return false;
      });
    } else {
      for_each_entry(leaf, [&](std::uint32_t i) {
        slow_.consider_all(slow_.context, scope_.first_id() + scope_.others[i], packet_);
        return false;
      });
    }
  }

  /// The rays for the boxes of the tree that they traverse.
  [[nodiscard]] const PacketBoxRays& boxes() const { return scope_.choose(packet_.boxes, inner_); }

  void meet_block(std::uint32_t index) {
    const TriangleBlock& block = scope_.blocks[index];
    if (scope_.instance == nullptr) return meet_block(block, index);
    TriangleBlock placed;
    tree_.scene_block(*scope_.instance, block, placed);
    meet_block(placed, kNoBlock);
  }

  void meet_block(const TriangleBlock& block, std::uint32_t index) {
    const PacketView<kNodeLanes> view(block, packet_);
    for (int group = 0; group < kGroups; ++group) {
      if (view.seen[group] == 0) continue;
      const int first = group * kGroupRays;
      for (int i = first; i < first + kGroupRays; i += N)
        meet_triangles(view, group, i, block, index);
    }
  }

  // Tests the triangles that are not culled for this group of rays against the rays [i, i + N).
  void meet_triangles(const PacketView<kNodeLanes>& view, int group, int i,
                      const TriangleBlock& block, std::uint32_t index) {
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
                  maybe, certain, i, {block, k, slot(index, k)});
      }
    }
  }

  static constexpr std::uint32_t kNoBlock = ~0U;
  static std::uint32_t slot(std::uint32_t block, int lane) {
    return block == kNoBlock ? kNoSlot : block * kWidth + static_cast<std::uint32_t>(lane);
  }

  struct Quotient {
    F height, size;  // t = height / size
    float height_error, size_error;
  };
  struct Candidate {
    const TriangleBlock& block;
    int lane;
    std::uint32_t slot;
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
      store_where<N>(nearer, triangle.slot, packet_.best_slot + i);
    }
    for (Lanes lanes = maybe & ~nearer & ~farther; lanes != 0; lanes &= lanes - 1) {
      const int ray = i + first_lane(lanes);
      // A triangle with references in several leaves is tested more than once.
      if (packet_.best_id[ray] != id) decide_by_fallback(ray, id, triangle.slot);
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

  void decide_by_fallback(int ray, std::uint32_t id, std::uint32_t slot) {
    ClosestSoFar best{packet_.best_lo[ray], packet_.best_hi[ray], packet_.best_id[ray]};
    slow_.consider(slow_.context, ray, id, best);
    packet_.best_lo[ray] = best.lo;
    packet_.best_hi[ray] = best.hi;
    if (best.id != id) return;
    packet_.best_id[ray] = id;
    packet_.best_slot[ray] = slot;
  }

  const TreeView& tree_;
  KernelPacket& packet_;
  const PacketFallback& slow_;
  Scope scope_;
  PacketBoxRays inner_;  // the rays for boxes, in the scope of an instance
  float limit_ = 0;      // a hit beyond this t can't be the nearest hit of any ray
};

template <int N>
void closest_of_packet(const TreeView& tree, KernelPacket& packet, const PacketFallback& slow) {
  PacketWalk<N>(tree, packet, slow).run();
}

}  // namespace
}  // namespace microtrace
