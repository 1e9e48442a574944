#pragma once
/// Many unrelated rays in flight. A ray alone waits for memory, and for each step's result before
/// the next; here one pass steps every ray that stands at a node and the next every ray that stands
/// at a leaf, so that their steps overlap, and what a ray needs next is fetched meanwhile.

#include "accel/kernels/block_test.hpp"
#include "accel/kernels/node_test.hpp"
#include "accel/kernels/slabs.hpp"

namespace microtrace {
namespace {

template <int N, bool kAny>
class StreamWalk {
 public:
  StreamWalk(const TreeView& tree, KernelStream& stream, const StreamSlowPath& slow)
      : tree_(tree), stream_(stream), slow_(slow) {}

  void run() {
    prepare();
    for (Flight& flight : flights_) start(flight);
    while (lists_[kNodes].size + lists_[kLeaves].size > 0) {
      step(lists_[kNodes], [&](Flight& flight, ChildRef child) {
        push_children<N, kAny>(tree_.nodes[child], flight.ray, flight.best.hi, flight.stack);
      });
      step(lists_[kLeaves], [&](Flight& flight, ChildRef child) {
        meet_leaf<N, kAny>(tree_, flight.ray, child, flight.best,
                           [&](std::uint32_t id, Best& best) {
                             slow_.consider(slow_.context, flight.number, id, best);
                           });
        if (kAny && flight.best.id != kNoPrimitive) flight.stack.size = 1;
      });
    }
  }

 private:
  static constexpr int kInFlight = 32;
  static constexpr ChildRef kFinished = child_ref::kKind;  // below all else on a stack

  struct alignas(64) Flight {
    KernelRay ray;
    Best best;
    int number;
    RayStack stack;
  };

  struct List {
    int size = 0;
    Flight* flights[kInFlight];
  };
  enum { kNodes, kLeaves };

  void prepare() {
    using F = Float<N>;
    for (int i = 0; i < stream_.count; i += N) {
      F sum{};
      for (int axis = 0; axis < 3; ++axis) {
        const F d = load<N>(stream_.d[axis] + i);
        F near, far;
        slab_factors<N>(d, near, far);
        store<N>(stream_.near[axis] + i, near);
        store<N>(stream_.far[axis] + i, far);
        sum = sum + magnitude(d);
      }
      store<N>(stream_.d_sum + i, sum * (1 + 0x1p-21F));
      const F t_min = load<N>(stream_.t_min + i);
      store<N>(stream_.t_begin + i, t_min < all<N>(kLeastBegin) ? F{} : t_min);
    }
  }

  // Puts the next ray into a place, if there is one.
  void start(Flight& flight) {
    if (next_ == stream_.count) return;
    const int i = next_++;
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
    flight.best = {stream_.best_lo[i], stream_.best_hi[i], stream_.best_id[i]};
    flight.number = i;
    flight.stack.child[0] = kFinished;
    flight.stack.near[0] = 0;
    flight.stack.child[1] = tree_.root;
    flight.stack.near[1] = 0;
    flight.stack.size = kAny && flight.best.id != kNoPrimitive ? 1 : 2;
    settle(flight);
  }

  void finish(Flight& flight) {
    stream_.best_lo[flight.number] = flight.best.lo;
    stream_.best_hi[flight.number] = flight.best.hi;
    stream_.best_id[flight.number] = flight.best.id;
    start(flight);
  }

  template <class Visit>
  void step(List& list, const Visit& visit) {
    const List now = list;
    list.size = 0;
    for (int k = 0; k < now.size; ++k) {
      Flight& flight = *now.flights[k];
      const ChildRef child = flight.stack.child[--flight.stack.size];
      visit(flight, child);
      settle(flight);
    }
  }

  // Finds what the ray in a place visits next.
  void settle(Flight& flight) {
    int top = flight.stack.size - 1;
    if constexpr (!kAny) {
      while (flight.stack.near[top] > flight.best.hi) --top;
      flight.stack.size = top + 1;
    }
    const ChildRef child = flight.stack.child[top];
    const ChildRef kind = child & child_ref::kKind;
    if (kind == kFinished) {
      finish(flight);
      return;
    }
    fetch(child);
    // By index, not by a branch, which would be mispredicted often.
    List& list = lists_[kind != 0 ? kLeaves : kNodes];
    list.flights[list.size++] = &flight;
  }

  // Inlined by force: GCC takes a function of prefetches alone for one without effect.
  __attribute__((always_inline)) void fetch(ChildRef child) const {
    const auto* node = reinterpret_cast<const char*>(tree_.nodes + child);
    const auto* block =
        reinterpret_cast<const char*>(tree_.blocks + ((child & ~child_ref::kKind) >> 3U));
    const char* p = (child & child_ref::kKind) == 0 ? node : block;
    __builtin_prefetch(p);
    __builtin_prefetch(p + 64);
    __builtin_prefetch(p + 128);
    __builtin_prefetch(p + 192);
    const char* q = (child & child_ref::kKind) == 0 ? node : block + 256;
    __builtin_prefetch(q);
    __builtin_prefetch(q + 64);
  }

  const TreeView& tree_;
  KernelStream& stream_;
  const StreamSlowPath& slow_;
  int next_ = 0;  // ray to start
  List lists_[2];
  Flight flights_[kInFlight];
};

template <int N>
void closest_of_stream(const TreeView& tree, KernelStream& stream, const StreamSlowPath& slow) {
  StreamWalk<N, false>(tree, stream, slow).run();
}

template <int N>
void any_of_stream(const TreeView& tree, KernelStream& stream, const StreamSlowPath& slow) {
  StreamWalk<N, true>(tree, stream, slow).run();
}

}  // namespace
}  // namespace microtrace
