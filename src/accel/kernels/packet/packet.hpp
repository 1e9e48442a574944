#pragma once
/// Traverses the tree with up to 64 rays that have a common origin. A node's eight boxes are first
/// tested against the beam around all rays. Each remaining box is then tested against the rays,
/// group by group; groups of which no ray enters it are left out below.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/packet/packet_boxes.hpp"
#include "accel/kernels/packet/packet_triangles.hpp"
#include "accel/kernels/simd.hpp"
#include "accel/kernels/single_ray.hpp"

namespace microtrace {
namespace {

template <int N>
class PacketWalk {
 public:
  PacketWalk(const TreeView& tree, KernelPacket& packet, const PacketFallback& slow)
      : tree_(tree),
        packet_(packet),
        slow_(slow),
        triangles_(tree.open, packet, slow),
        scope_(tree) {
    update_limits(kAllGroups);
  }

  void run() {
    Entry stack[kStackSize];
    int top = 0;
    stack[top++] = {tree_.root, packet_.least_t_begin, kAllGroups};
    while (top > 0) {
      const Entry entry = stack[--top];
      if (entry.near > limit_of(entry.groups)) continue;
      if ((entry.child & child_ref::kKind) == 0) {
        top = push_children(scope_.nodes[entry.child], entry.groups, stack, top);
      } else if (entry.child == kInstanceEnd) {
        scope_ = Scope(tree_);
      } else if (is_instance(entry.child)) {
        const Instance& instance = tree_.instances[entry.child - child_ref::kFirstInstance];
        const MeshTree& mesh = tree_.meshes[instance.mesh];
        if (enter<N>(instance, packet_, entry.groups, inner_)) {
          scope_ = Scope(mesh, instance);
          inner_groups_.known = 0;
          stack[top++] = {kInstanceEnd, -__builtin_inff(), kAllGroups};
          stack[top++] = {mesh.root, entry.near, entry.groups};
        } else {
          for (std::uint32_t i = 0; i < mesh.triangles; ++i)
            slow_.consider_all(slow_.context, instance.first_id + i, packet_);
          update_limits(kAllGroups);
        }
      } else {
        meet_leaf(entry.child, entry.groups);
      }
    }
  }

 private:
  using F = Float<N>;
  static constexpr int kNodeLanes = N < kWidth ? N : kWidth;
  using B = Float<kNodeLanes>;

  /// A part of a tree, and the groups whose rays may enter it. Small parts are entered by few
  /// groups.
  struct Entry {
    ChildRef child;
    float near;
    Groups groups;
  };

  /// Bounds of each group's factors, computed when they are first needed.
  struct GroupBounds {
    FactorBounds of[kGroups];
    Groups known = 0;
  };

  static bool is_one(Groups groups) { return (groups & (groups - 1)) == 0; }

  void update_limits(Groups groups) {
    if (groups == kAllGroups) {
      F limit = load<N>(packet_.best_hi);
      for (int i = N; i < kPacketRays; i += N) limit = greater(limit, load<N>(packet_.best_hi + i));
      const float all = greatest_of<N>(limit);
      for (float& group : limit_) group = all;
      return;
    }
    for_each_group(groups, [&](int group) {
      const int first = group * kGroupRays;
      const float* hits = packet_.best_hi + first;
      F limit = load<N>(hits);
      for (int i = N; i < kGroupRays; i += N) limit = greater(limit, load<N>(hits + i));
      limit_[group] = greatest_of<N>(limit);
    });
  }
  /// A hit beyond this t can't be the nearest hit of any ray of these groups.
  [[nodiscard]] float limit_of(Groups groups) const {
    float limit = limit_[first_lane(groups)];
    for_each_group(groups & (groups - 1),
                   [&](int group) { limit = greater(limit, limit_[group]); });
    return limit;
  }

  /// Bounds of the factors of these groups' rays.
  [[nodiscard]] const FactorBounds& bounds_of(Groups groups) {
    if (!is_one(groups)) return boxes().bounds;
    GroupBounds& bounds = scope_.instance == nullptr ? outer_groups_ : inner_groups_;
    const int group = first_lane(groups);
    if ((bounds.known & groups) == 0) bound_factors<N>(boxes(), group, bounds.of[group]);
    bounds.known |= groups;
    return bounds.of[group];
  }

  // The planes of a node's children through which the rays enter and leave along an axis, and the
  // origins for them.
  struct Slab {
    const float *enter, *leave;
    float o_of_enter, o_of_leave;
  };
  [[nodiscard]] Slab slab(const WideNode& node, const FactorBounds& bounds, int axis) const {
    const float* lo = axis == 0 ? node.lo_x : axis == 1 ? node.lo_y : node.lo_z;
    const float* hi = axis == 0 ? node.hi_x : axis == 1 ? node.hi_y : node.hi_z;
    const float o_of_lo = boxes().o_of_lo[axis], o_of_hi = boxes().o_of_hi[axis];
    return bounds.negative[axis] ? Slab{hi, lo, o_of_hi, o_of_lo} : Slab{lo, hi, o_of_lo, o_of_hi};
  }

  int push_children(const WideNode& node, Groups groups, Entry* stack, int top) {
    const FactorBounds& bounds = bounds_of(groups);
    const float limit = limit_of(groups);
    alignas(64) float near[kWidth];
    Lanes entered = 0;
    for (int i = 0; i < kWidth; i += kNodeLanes) {
      B enter = all<kNodeLanes>(packet_.least_t_begin), leave = all<kNodeLanes>(limit);
      for (int axis = 0; axis < 3; ++axis) {
        if (!bounds.common_sign[axis]) continue;
        const Slab planes = slab(node, bounds, axis);
        const B in = load<kNodeLanes>(planes.enter + i) - planes.o_of_enter;
        const B out = load<kNodeLanes>(planes.leave + i) - planes.o_of_leave;
        enter =
            greater(lesser(in * bounds.least_near[axis], in * bounds.greatest_near[axis]), enter);
        leave =
            lesser(greater(out * bounds.least_far[axis], out * bounds.greatest_far[axis]), leave);
      }
      entered |= less_equal<kNodeLanes>(enter, leave) << i;
      store<kNodeLanes>(near + i, enter);
    }
    const int first = top;
    for (; entered != 0; entered &= entered - 1) {
      const int lane = first_lane(entered);
      const Groups entering = entering_groups({boxes(), node, lane}, groups, bounds);
      if (entering == 0) continue;
      const Entry entry{node.child[lane], near[lane], entering};
      fetch(entry.child);
      int slot = top++;
      for (; slot > first && stack[slot - 1].near < entry.near; --slot)
        stack[slot] = stack[slot - 1];
      stack[slot] = entry;
    }
    return top;
  }

  // Returns the groups of which a ray enters a box. All are tested, because knowing the others
  // saves more below, even where boxes are large.
  [[nodiscard]] Groups entering_groups(const SeenBox& box, Groups groups,
                                       const FactorBounds& bounds) const {
    Groups entering = 0;
    for_each_group(groups, [&](int group) {
      const bool is_entered = box.is_entered<N>(packet_, boxes(), bounds, group);
      entering |= Groups{is_entered} << group;
    });
    return entering;
  }

  // Always inlined, because GCC removes calls of a function that only prefetches.
  __attribute__((always_inline)) void fetch(ChildRef child) const {
    const bool is_node = (child & child_ref::kKind) == 0;
    // Addresses are computed as integers, because the array is null if there are no triangles.
    const auto p = is_node
                       ? reinterpret_cast<std::uintptr_t>(scope_.nodes) + child * sizeof(WideNode)
                       : reinterpret_cast<std::uintptr_t>(scope_.blocks) +
                             entries_of(child).begin * sizeof(TriangleBlock);
    for (std::uintptr_t i = 0; i < 4; ++i) {
      // NOLINTNEXTLINE(performance-no-int-to-ptr): only prefetched
      __builtin_prefetch(reinterpret_cast<const void*>(p + 64 * i));
    }
  }

  void meet_leaf(ChildRef leaf, Groups groups) {
    if ((leaf & child_ref::kKind) == child_ref::kTriangles) {
      for_each_entry(leaf, [&](std::uint32_t i) {
        meet_block(i, groups);
        return false;
      });
      update_limits(groups);
    } else {
      for_each_entry(leaf, [&](std::uint32_t i) {
        slow_.consider_all(slow_.context, scope_.first_id() + scope_.others[i], packet_);
        return false;
      });
      update_limits(kAllGroups);
    }
  }

  /// The rays for the boxes of the tree that they traverse.
  [[nodiscard]] const PacketBoxRays& boxes() const { return scope_.choose(packet_.boxes, inner_); }

  void meet_block(std::uint32_t index, Groups groups) {
    const TriangleBlock& block = scope_.blocks[index];
    if (scope_.instance == nullptr) return triangles_.meet(block, groups);
    TriangleBlock placed;
    tree_.scene_block(*scope_.instance, block, placed);
    triangles_.meet(placed, groups);
  }

  const TreeView& tree_;
  KernelPacket& packet_;
  const PacketFallback& slow_;
  PacketTriangles<N> triangles_;
  Scope scope_;
  PacketBoxRays inner_;  // the rays for boxes, in the scope of an instance
  GroupBounds outer_groups_, inner_groups_;
  float limit_[kGroups];  // see limit_of()
};

template <int N>
void closest_of_packet(const TreeView& tree, KernelPacket& packet, const PacketFallback& slow) {
  PacketWalk<N>(tree, packet, slow).run();
}

}  // namespace
}  // namespace microtrace
