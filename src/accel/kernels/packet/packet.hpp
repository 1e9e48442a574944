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
      // Loads the members one by one, as they were stored. Wider loads of an entry that was just
      // pushed would wait for its stores.
      const Entry& pushed = stack[--top];
      const Entry entry{pushed.child, pushed.near, pushed.groups};
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
      for (float& group : group_limits_) group = all;
    } else {
      for_each_group(groups, [&](int group) {
        const int first = group * kGroupRays;
        const float* hits = packet_.best_hi + first;
        F limit = load<N>(hits);
        for (int i = N; i < kGroupRays; i += N) limit = greater(limit, load<N>(hits + i));
        group_limits_[group] = greatest_of<N>(limit);
      });
    }
    // For each group, the sets that contain it. A set of groups is the index of its limit.
    constexpr Lanes kSetsWith[kGroups] = {0xAAAA, 0xCCCC, 0xF0F0, 0xFF00};
    for (int i = 0; i < kSets; i += N) {
      F limit = all<N>(-__builtin_inff());
      for (int group = 0; group < kGroups; ++group)
        limit = select<N>(kSetsWith[group] >> i & kAllLanes<N>,
                          greater(all<N>(group_limits_[group]), limit), limit);
      store<N>(limits_ + i, limit);
    }
  }
  /// A hit beyond this t can't be the nearest hit of any ray of these groups.
  [[nodiscard]] float limit_of(Groups groups) const { return limits_[groups]; }

  /// Bounds of the factors of these groups' rays.
  [[nodiscard]] const FactorBounds& bounds_of(Groups groups) {
    if (!is_one(groups)) return boxes().bounds;
    GroupBounds& bounds = scope_.instance == nullptr ? outer_groups_ : inner_groups_;
    const int group = first_lane(groups);
    if ((bounds.known & groups) == 0) bound_factors<N>(boxes(), group, bounds.of[group]);
    bounds.known |= groups;
    return bounds.of[group];
  }

  int push_children(const WideNode& node, Groups groups, Entry* stack, int top) {
    const FactorBounds& bounds = bounds_of(groups);
    const BeamTest<kNodeLanes> beam(node, boxes(), bounds, packet_.least_t_begin, limit_of(groups));
    const int first = top;
    for (Lanes entered = beam.entered; entered != 0; entered &= entered - 1) {
      const int lane = first_lane(entered);
      const Groups entering =
          bounds.all_common
              ? groups_of(groups,
                          [&](int group) {
                            return enters_in_order<N>(packet_, boxes(), beam, lane, group);
                          })
              : groups_of(groups, [&](int group) {
                  return enters<N>(packet_, boxes(), node, lane, group);
                });
      if (entering == 0) continue;
      const Entry entry{node.child[lane], beam.near[lane], entering};
      fetch(entry.child);
      int slot = top++;
      for (; slot > first && stack[slot - 1].near < entry.near; --slot)
        stack[slot] = stack[slot - 1];
      stack[slot] = entry;
    }
    return top;
  }

  // Returns the groups for which `enters` is true. All are tested, because knowing the others saves
  // more below, even where boxes are large.
  template <class Enters>
  [[nodiscard]] static Groups groups_of(Groups groups, const Enters& enters) {
    Groups entering = 0;
    for_each_group(groups, [&](int group) { entering |= Groups{enters(group)} << group; });
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
  static constexpr int kSets = 1 << kGroups;
  float group_limits_[kGroups];
  alignas(64) float limits_[kSets];  // see limit_of()
};

template <int N>
void closest_of_packet(const TreeView& tree, KernelPacket& packet, const PacketFallback& slow) {
  PacketWalk<N>(tree, packet, slow).run();
}

}  // namespace
}  // namespace microtrace
