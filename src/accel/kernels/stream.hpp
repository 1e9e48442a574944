#pragma once
/// Traces many incoherent rays at a time. A ray traced alone waits for memory, and each step waits
/// for the result of the previous step. Here, one pass advances all rays that are at a node, and
/// the next pass all rays that are at a leaf. The steps of different rays overlap, and the data for
/// each ray's next step is prefetched.

#include "accel/kernels/block_test.hpp"
#include "accel/kernels/few_triangles.hpp"
#include "accel/kernels/node_test.hpp"
#include "accel/kernels/occlusion_packet.hpp"
#include "accel/kernels/slabs.hpp"

namespace microtrace {
namespace {

template <int N>
void prepare_stream(KernelStream& stream) {
  using F = Float<N>;
  const F zero{}, one = all<N>(1.0F), farthest = all<N>(kFarthestCoordinate);
  for (int i = 0; i < stream.count; i += N) {
    F t_min = load<N>(stream.t_min + i), t_max = load<N>(stream.best_hi + i), size{};
    Lanes suited =
        less_equal<N>(zero, t_min) & less_equal<N>(t_min, farthest) & less_equal<N>(t_min, t_max);
    for (int axis = 0; axis < 3; ++axis) {
      const F length = magnitude(load<N>(stream.d[axis] + i));
      size = greater(length, size);
      suited &= less_equal<N>(length, all<N>(kLongestDirection)) &
                less_equal<N>(magnitude(load<N>(stream.o[axis] + i)), farthest);
    }
    suited &= less_equal<N>(all<N>(kShortestDirection), size);
    F sum{};
    for (int axis = 0; axis < 3; ++axis) {
      F d = load<N>(stream.d[axis] + i), near, far;
      if (suited != kAllLanes<N>) {
        d = select<N>(suited, d, one);
        store<N>(stream.d[axis] + i, d);
        store<N>(stream.o[axis] + i, select<N>(suited, load<N>(stream.o[axis] + i), zero));
      }
      slab_factors<N>(d, near, far);
      store<N>(stream.near[axis] + i, near);
      store<N>(stream.far[axis] + i, far);
      sum = sum + magnitude(d);
    }
    t_min = select<N>(suited, t_min, zero);
    t_max = select<N>(suited, t_max, zero);
    store<N>(stream.d_sum + i, sum * (1 + 0x1p-21F));
    store<N>(stream.t_min + i, t_min);
    store<N>(stream.t_begin + i, t_min < all<N>(kLeastBegin) ? zero : t_min);
    store<N>(stream.best_lo + i, t_max);
    store<N>(stream.best_hi + i, t_max);
    const int shift = i % 64;
    std::uint64_t& set = stream.suited[i / 64];
    set = (shift == 0 ? 0 : set) | std::uint64_t{suited} << shift;
  }
  // Fills the last packet by repeating the last ray.
  for (int i = stream.count; i % kPacketRays != 0; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      stream.o[axis][i] = stream.o[axis][i - 1];
      stream.d[axis][i] = stream.d[axis][i - 1];
    }
    stream.best_hi[i] = stream.best_hi[i - 1];
    stream.omitted_id[i] = stream.omitted_id[i - 1];
  }
  __builtin_memset(stream.best_id, 0xff, sizeof stream.best_id);
  static_assert(kNoPrimitive == 0xffffffff);
}

template <int N, bool kAny>
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
        next = step_into<N, kAny>(tree_.nodes[next], flight.ray, flight.best.hi, flight.stack);
      });
      meet_blocks();
      for_each(others_, [&](Flight& flight, ChildRef& next) {
        meet_leaf<N, kAny>(tree_, flight.ray, next, flight.best, fallback(flight));
        next = next_after_leaf(flight);
      });
      for (int k = 0; k < finished_.size; ++k) finish(finished_.slot[k]);
    }
  }

 private:
  static constexpr std::uint32_t kInFlight = 32;
  static constexpr ChildRef kEmpty = ~ChildRef{0};

  struct alignas(64) Flight {
    KernelRay ray;
    ClosestSoFar best;
    int number;
    RayStack stack;
    BlockTest<N> test;
  };

  struct List {
    int size = 0;
    std::uint32_t slot[kInFlight + 8];  // with room for stores of eight elements at a time
  };

  struct MaybeHit {
    Flight* flight;
    const TriangleBlock* block;
  };

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
      flight.ray.near_factor[axis] = stream_.near[axis][i];
      flight.ray.far_factor[axis] = stream_.far[axis][i];
    }
    find_planes(flight.ray);
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
      fetch(next_[slot]);
    }
  }

  // Processes all rays at triangle leaves in two loops: first the tests, which don't branch, then
  // the few possible hits.
  void meet_blocks() {
    int hits = 0;
    for_each(leaves_, [&](Flight& flight, ChildRef& next) {
      const TriangleBlock& block = tree_.blocks[first_entry(next)];
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

  auto fallback(const Flight& flight) const {
    return [this, &flight](std::uint32_t id, ClosestSoFar& best) {
      slow_.consider(slow_.context, flight.number, id, best);
    };
  }

  // Sorts the slots in use by the kind of subtree that their rays visit next, and returns the
  // number of these slots. Avoids branches, which would often be mispredicted.
  int sort_places() {
    nodes_.size = leaves_.size = others_.size = finished_.size = 0;
    for (std::uint32_t first = 0; first < kInFlight; first += 8) {
      const auto list = [&](List& to, ChildRef least, ChildRef greatest) {
        const Lanes lanes = lanes_within(next_ + first, least, greatest);
        std::uint32_t slots[8];
        for (std::uint32_t i = 0; i < 8; ++i) slots[i] = first + i;
        store_lanes(lanes, slots, to.slot + to.size);
        to.size += __builtin_popcount(lanes);
      };
      list(nodes_, 0, child_ref::kTriangles - 1);
      list(leaves_, child_ref::kTriangles, child_ref::kOthers - 1);
      list(others_, child_ref::kOthers, kFinished - 1);
      list(finished_, kFinished, kFinished);
    }
    return nodes_.size + leaves_.size + others_.size + finished_.size;
  }

  // Describes where the data of one kind of ChildRef is stored: at begin + (child & mask) * scale.
  struct Place {
    const char* begin;
    std::size_t mask, scale;
    std::size_t last;  // offset of the last cache line to prefetch, in bytes
  };

  // Always inlined, because GCC removes calls of a function that only prefetches.
  __attribute__((always_inline)) void fetch(ChildRef child) const {
    const Place& slot = slots_[child >> 30U];
    // A number instead of a pointer, because `begin` is null if there is no data of this kind.
    const std::uintptr_t p =
        reinterpret_cast<std::uintptr_t>(slot.begin) + (child & slot.mask) * slot.scale;
    // NOLINTBEGIN(performance-no-int-to-ptr): only prefetched
    __builtin_prefetch(reinterpret_cast<const void*>(p));
    __builtin_prefetch(reinterpret_cast<const void*>(p + 64));
    __builtin_prefetch(reinterpret_cast<const void*>(p + 128));
    __builtin_prefetch(reinterpret_cast<const void*>(p + 192));
    __builtin_prefetch(reinterpret_cast<const void*>(p + slot.last));
    // NOLINTEND(performance-no-int-to-ptr)
  }

  const TreeView& tree_;
  KernelStream& stream_;
  const StreamFallback& slow_;
  const StreamItems* items_;
  int started_ = 0;  // number of rays or items started so far
  List nodes_, leaves_, others_, finished_;
  ChildRef next_[kInFlight];  // the subtree that the ray in each slot visits next
  static_assert(sizeof(TriangleBlock) % 8 == 0);
  const Place slots_[4] = {
      {reinterpret_cast<const char*>(tree_.nodes), ~child_ref::kKind, sizeof(WideNode), 192},
      {reinterpret_cast<const char*>(tree_.blocks), ~child_ref::kKind & ~7U,
       sizeof(TriangleBlock) / 8, 256},
      {reinterpret_cast<const char*>(tree_.others), 0, 0, 0},
      {reinterpret_cast<const char*>(tree_.nodes), 0, 0, 0}};
  MaybeHit hits_[kInFlight + 1];
  Flight flights_[kInFlight];
};

/// M: number of rays that are tested against one triangle at a time.
template <int N, int M>
void closest_of_stream(const TreeView& tree, KernelStream& stream, const StreamFallback& slow) {
  if (has_few_triangles<M>(tree))
    FewTrianglesWalk<M>(tree, stream, slow).run();
  else
    StreamWalk<N, false>(tree, stream, slow, nullptr).run();
}

/// M is the number of rays that packets test at a time.
template <int N, int M>
void any_of_stream(const TreeView& tree, KernelStream& stream, const StreamFallback& slow) {
  StreamItems items;
  OcclusionPacketWalk<M> packets(tree, stream, slow, items);
  for (int first = 0; first < stream.count; first += OcclusionPacketWalk<M>::kRays)
    packets.run(first);
  StreamWalk<N, true>(tree, stream, slow, &items).run();
}

}  // namespace
}  // namespace microtrace
