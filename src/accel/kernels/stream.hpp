#pragma once
/// Traces many incoherent rays at a time. A ray traced alone waits for memory, and each step waits
/// for the result of the previous step. Here, one pass advances all rays that are at a node, and
/// the next pass all rays that are at a leaf. The steps of different rays overlap, and the data for
/// each ray's next step is prefetched.

#include "accel/kernels/block_test.hpp"
#include "accel/kernels/entering_rays.hpp"
#include "accel/kernels/node_test.hpp"
#include "accel/kernels/slabs.hpp"
#include "simd/lane_count.hpp"

namespace microtrace {
namespace {

/// kInstances must be true if the tree has instances. Otherwise, no ray has a scope of its own.
template <int N, bool kAny, bool kInstances>
class StreamWalk {
 public:
  /// Traces the rays and subtrees in `items`. If `items` is null, all rays traverse the whole tree.
  StreamWalk(const TreeView& tree, KernelStream& stream, const StreamFallback& slow,
             const StreamItems* items)
      : tree_(tree), stream_(stream), slow_(slow), items_(items) {}

  void run() {
    for (std::uint32_t slot = 0; slot < kInFlight; ++slot) start(slot);
    while (sort_places() > 0) {
      for_each(nodes_, [&](Flight& flight, ChildRef& next) {
        next = step_into<N, kAny>(scope(flight).nodes[next],
                                  in_instance(flight) ? flight.inner.box : flight.ray.box,
                                  flight.ray.t_begin, flight.best.hi, flight.stack);
      });
      meet_blocks();
      for_each(others_, [&](Flight& flight, ChildRef& next) {
        meet_leaf<N, kAny>(tree_, scope(flight), flight.ray, flight.inner, next, flight.best,
                           fallback(flight));
        next = next_after_leaf(flight);
      });
      if constexpr (kInstances) meet_instances();
      for (int k = 0; k < finished_.size; ++k) finish(finished_.slot[k]);
    }
  }

 private:
  static constexpr std::uint32_t kInFlight = 32;
  static constexpr ChildRef kEmpty = ~ChildRef{0};

  // The data that every step needs come first, so that few cache lines and pages are in use.
  struct alignas(64) Flight {
    KernelRay ray;
    ClosestSoFar best;
    int number;
    BlockTest<N> test;
    RayStack<kInstances> stack;
    Scope scope;
    InnerRay inner;  // in the scope of an instance
    char unused[64];
  };
  // With an even number of cache lines, the flights' data would compete for a part of the cache.
  static_assert(sizeof(Flight) / 64 % 2 == 1);

  // The tree that a ray traverses.
  [[nodiscard]] const Scope& scope(const Flight& flight) const {
    return kInstances ? flight.scope : whole_;
  }
  [[nodiscard]] static bool in_instance(const Flight& flight) {
    return kInstances && flight.scope.instance != nullptr;
  }

  // The numbers of all slots. Vectors are loaded from here, because a vector of numbers that were
  // just stored would have to wait for them.
  struct Slots {
    std::uint32_t number[kInFlight];
  };
  static constexpr Slots kSlots = [] {
    Slots slots{};
    for (std::uint32_t i = 0; i < kInFlight; ++i) slots.number[i] = i;
    return slots;
  }();

  struct List {
    int size = 0;
    std::uint32_t slot[kInFlight + 8];  // with room for stores of eight elements at a time
  };

  struct MaybeHit {
    Flight* flight;
    const TriangleBlock* block;
  };

  [[nodiscard]] const Instance& instance_at(ChildRef child) const {
    return tree_.instances[child - child_ref::kFirstInstance];
  }

  // Processes all rays at instances in two loops: the first prefetches the matrices for the second.
  void meet_instances() {
    for (int k = 0; k < instances_.size; ++k) {
      const ChildRef child = next_[instances_.slot[k]];
      if (child == kInstanceEnd) continue;
      const double* const matrix = instance_at(child).scene_from_mesh;
      __builtin_prefetch(matrix);
      __builtin_prefetch(matrix + 11);
    }
    for_each(instances_, [&](Flight& flight, ChildRef& next) { meet_instance(flight, next); });
  }

  // Enters an instance, or leaves it if all of its subtrees have been visited.
  void meet_instance(Flight& flight, ChildRef& next) {
    if (next == kInstanceEnd) {
      flight.scope = Scope(tree_);
    } else {
      const Instance& instance = instance_at(next);
      if (enter(instance, flight.ray, flight.inner)) {
        const MeshTree& mesh = tree_.meshes[instance.mesh];
        flight.scope = Scope(mesh, instance);
        flight.stack.push_instance_end();
        next = mesh.root;
        return;
      }
      consider_instance(tree_, instance, flight.ray, flight.best, fallback(flight));
    }
    next = next_after_leaf(flight);
  }

  // Starts the next ray, if there is one, in a slot.
  void start(std::uint32_t slot) {
    const int last = items_ != nullptr ? items_->size : stream_.count;
    const auto item = [&](int i) {
      return items_ != nullptr ? items_->item[i] : StreamItem{i, tree_.root};
    };
    while (kAny && started_ < last && stream_.best_id[item(started_).ray] != kNoPrimitive)
      ++started_;
    if (started_ == last) {
      next_[slot] = kEmpty;
      return;
    }
    const auto [i, child] = item(started_++);
    Flight& flight = flights_[slot];
    for (int axis = 0; axis < 3; ++axis) {
      flight.ray.o[axis] = stream_.o[axis][i];
      flight.ray.d[axis] = stream_.d[axis][i];
      flight.ray.box.near_factor[axis] = stream_.near[axis][i];
      flight.ray.box.far_factor[axis] = stream_.far[axis][i];
    }
    set_origin(flight.ray.o, flight.ray.box);
    find_planes(flight.ray.d, flight.ray.box);
    if constexpr (kInstances) flight.scope = Scope(tree_);
    flight.ray.t_min = stream_.t_min[i];
    flight.ray.t_begin = stream_.t_begin[i];
    flight.ray.d_sum = stream_.d_sum[i];
    flight.ray.omitted_id = stream_.omitted_id[i];
    flight.best = {stream_.best_lo[i], stream_.best_hi[i], stream_.best_id[i]};
    flight.number = i;
    flight.stack.clear();
    next_[slot] = child;
  }

  void finish(std::uint32_t slot) {
    const Flight& flight = flights_[slot];
    if (kAny && flight.best.id == kNoPrimitive) {
      start(slot);
      return;
    }
    stream_.best_lo[flight.number] = flight.best.lo;
    stream_.best_hi[flight.number] = flight.best.hi;
    stream_.best_id[flight.number] = flight.best.id;
    start(slot);
  }

  template <class Visit>
  void for_each(const List& list, const Visit& visit) {
    for (int k = 0; k < list.size; ++k) {
      const std::uint32_t slot = list.slot[k];
      visit(flights_[slot], next_[slot]);
      fetch(next_[slot], scope(flights_[slot]));
    }
  }

  // Processes all rays at triangle leaves in two loops: first the tests, which don't branch, then
  // the few possible hits.
  void meet_blocks() {
    int hits = 0;
    // Always inlined, because GCC would not do so by itself, which makes traversal a tenth slower.
    for_each(
        leaves_, [&](Flight & flight, ChildRef & next) __attribute__((always_inline)) {
          const TriangleBlock& block = scope(flight).blocks[entries_of(next).begin];
          if (in_instance(flight))
            flight.test.run(block, flight.inner, flight.ray.t_begin, flight.best.hi);
          else
            flight.test.run(block, flight.ray, flight.best.hi);
          hits_[hits] = {&flight, &block};
          hits += flight.test.maybe != 0;
          // The leaf's remaining blocks are pushed as a separate leaf.
          const int top = flight.stack.size;
          flight.stack.child[top] = next + (1U << 3U) - 1;
          flight.stack.near[top] = 0;
          flight.stack.size += (next & 7U) != 0;
          next = pop<kAny>(flight.stack, flight.best.hi);
        });
    for (int k = 0; k < hits; ++k) {
      const auto [flight, block] = hits_[k];
      if (in_instance(*flight))
        meet_instance_lanes<N, kAny>(tree_, *flight->scope.instance, *block, flight->test,
                                     flight->ray, flight->best, fallback(*flight));
      else
        meet_lanes<N, kAny>(tree_, *block, flight->test, flight->ray, flight->best,
                            fallback(*flight));
      ++flight->stack.size;  // pushes the popped entry again, which may be beyond the new hit
      next_[flight - flights_] = next_after_leaf(*flight);
    }
  }

  static ChildRef next_after_leaf(Flight& flight) {
    return kAny && flight.best.id != kNoPrimitive ? kFinished
                                                  : pop<kAny>(flight.stack, flight.best.hi);
  }

  [[nodiscard]] StreamRayFallback fallback(const Flight& flight) const {
    return {slow_, flight.number};
  }

  // Sorts the slots in use by the kind of subtree that their rays visit next, and returns the
  // number of these slots. Avoids branches, which would often be mispredicted.
  int sort_places() {
    nodes_.size = leaves_.size = others_.size = instances_.size = finished_.size = 0;
    for (std::uint32_t first = 0; first < kInFlight; first += 8) {
      const auto list = [&](List& to, ChildRef least, ChildRef greatest) {
        const Lanes lanes = lanes_within(next_ + first, least, greatest);
        store_lanes(lanes, kSlots.number + first, to.slot + to.size);
        to.size += lane_count(lanes);
      };
      list(nodes_, 0, child_ref::kTriangles - 1);
      list(leaves_, child_ref::kTriangles, child_ref::kOthers - 1);
      list(others_, child_ref::kOthers, kFinished - 1);
      list(finished_, kFinished, kFinished);
      if constexpr (kInstances) list(instances_, child_ref::kFirstInstance, kInstanceEnd);
    }
    return nodes_.size + leaves_.size + others_.size + instances_.size + finished_.size;
  }

  // Describes where the data of one kind of ChildRef is stored: at begin + (child & mask) * scale.
  struct Place {
    std::uintptr_t begin;  // a number, because the array is null if there is no data of this kind
    std::size_t mask, scale;
  };

  // Always inlined, because GCC removes calls of a function that only prefetches. Looks the kind up
  // in tables, because a branch would often be mispredicted.
  __attribute__((always_inline)) void fetch(ChildRef child, const Scope& scope) const {
    const Place& place = places_[child >> 30U];
    std::uintptr_t begin = place.begin;
    if constexpr (kInstances) {
      if (is_instance(child)) {
        const auto* const bytes = reinterpret_cast<const char*>(&instance_at(child));
        __builtin_prefetch(bytes);
        __builtin_prefetch(bytes + sizeof(Instance) - 1);
        return;
      }
      const std::uintptr_t begins[2] = {reinterpret_cast<std::uintptr_t>(scope.nodes),
                                        reinterpret_cast<std::uintptr_t>(scope.blocks)};
      begin = begins[child >> 30U & 1U];
    }
    const std::uintptr_t p = begin + (child & place.mask) * place.scale;
    // NOLINTBEGIN(performance-no-int-to-ptr): only prefetched
    __builtin_prefetch(reinterpret_cast<const void*>(p));
    __builtin_prefetch(reinterpret_cast<const void*>(p + 64));
    __builtin_prefetch(reinterpret_cast<const void*>(p + 128));
    __builtin_prefetch(reinterpret_cast<const void*>(p + 192));
    // NOLINTEND(performance-no-int-to-ptr)
  }

  const TreeView& tree_;
  KernelStream& stream_;
  const StreamFallback& slow_;
  const StreamItems* items_;
  const Scope whole_{tree_};  // the scope of all rays if there are no instances
  int started_ = 0;           // number of rays or items started so far
  List nodes_, leaves_, others_, instances_, finished_;
  ChildRef next_[kInFlight];  // the subtree that the ray in each slot visits next
  static_assert(sizeof(TriangleBlock) % 8 == 0);
  const Place places_[4] = {
      {reinterpret_cast<std::uintptr_t>(tree_.nodes), ~child_ref::kKind, sizeof(WideNode)},
      {reinterpret_cast<std::uintptr_t>(tree_.blocks), ~child_ref::kKind & ~7U,
       sizeof(TriangleBlock) / 8},
      {},
      {}};
  MaybeHit hits_[kInFlight + 1];
  Flight flights_[kInFlight];
};

}  // namespace
}  // namespace microtrace
