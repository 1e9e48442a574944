#pragma once
/// Tests eight triangles against a ray. The result for each triangle is a certain miss, a certain
/// hit with t in an interval, or uncertain; the fallback decides uncertain lanes.

#include "accel/kernels/block_corners.hpp"
#include "accel/kernels/edge_test.hpp"
#include "accel/kernels/inner_ray.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"
#include "accel/kernels/volume_test.hpp"
#include "base/bit_set.hpp"

namespace microtrace {
namespace {

/// Tests eight triangles against a ray.
template <int N>
struct BlockTest {
  Lanes maybe, certain;  ///< as in VolumeTest

  /// Tests the triangles of a block; hits certainly beyond t_limit are misses. Always inlined,
  /// because GCC would not inline it by itself, which makes traversal a tenth slower.
  __attribute__((always_inline)) void run(const TriangleBlock& block, const KernelRay& ray,
                                          float t_limit) {
    run_line(block, {ray.o, ray.d, ray.d_sum, kNoSlack}, ray.t_begin, t_limit);
  }
  /// Tests an instance's mesh. Lanes outside of `maybe` are certain misses of the instance's
  /// triangles; the other results have no meaning.
  __attribute__((always_inline)) void run(const TriangleBlock& block, const InnerRay& ray,
                                          float t_begin, float t_limit) {
    run_line(block, {ray.o, ray.d, ray.d_sum, ray.slack}, t_begin, t_limit);
  }

  /// True if t() is valid for a lane.
  [[nodiscard]] bool has_t(int lane) const { return size_[lane] > 16 * size_error_; }
  /// Returns bounds of t for a lane that is a certain hit.
  [[nodiscard]] Interval<float> t(int lane) const {
    return interval(height_[lane], size_[lane], height_error_[lane], size_error_);
  }

 private:
  struct Line {
    const float (&o)[3], (&d)[3];
    float d_sum, slack;
  };

  __attribute__((always_inline)) void run_line(const TriangleBlock& block, const Line& ray,
                                               float t_begin, float t_limit) {
    using F = Float<N>;
    const float limit = t_limit < kFarthestHit ? t_limit : kFarthestHit;
    maybe = certain = 0;
    for (int i = 0; i < kWidth; i += N) {
      const BlockCorners<N> corners(block, i);
      const auto& [p, q, r] = corners.of;
      const F a[3] = {p[0] - ray.o[0], p[1] - ray.o[1], p[2] - ray.o[2]};
      const F e1[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
      const F e2[3] = {r[0] - p[0], r[1] - p[1], r[2] - p[2]};
      const VolumeTest<N, float> test(a, e1, e2, ray.d, block.largest_edge, block.edge_product,
                                      ray.d_sum, t_begin, limit, ray.slack);
      maybe |= test.maybe << i;
      certain |= test.certain << i;
      size_error_ = test.size_error;
      store<N>(height_ + i, test.height);
      store<N>(size_ + i, test.size);
      store<N>(height_error_ + i, test.height_error);
    }
  }

  float size_error_;
  alignas(32) float height_[kWidth], size_[kWidth], height_error_[kWidth];
};

/// The callbacks for a ray without masked triangles.
struct RayFallback {
  const Fallback& slow;

  void operator()(std::uint32_t id, ClosestSoFar& best) const {
    slow.consider(slow.context, id, best);
  }
  [[nodiscard]] Visible visible(std::uint32_t, const HitWeights&) const { return Visible::yes; }
};
/// The callbacks for one ray of a stream.
struct StreamRayFallback {
  const StreamFallback& slow;
  int ray;

  void operator()(std::uint32_t id, ClosestSoFar& best) const {
    slow.consider(slow.context, ray, id, best);
  }
  [[nodiscard]] Visible visible(std::uint32_t id, const HitWeights& at) const {
    return slow.visible(slow.context, ray, id, at);
  }
};

/// Calls f(entry) for each entry of a leaf until f returns true. Returns true if f did.
template <class F>
inline bool for_each_entry(ChildRef leaf, const F& f) {
  const auto [begin, end] = entries_of(leaf);
  for (std::uint32_t i = begin; i < end; ++i) {
    if (f(i)) return true;
  }
  return false;
}

/// A hit that a test has not rejected. `t` is valid if has_t is set, which it is for certain hits.
struct PossibleHit {
  Interval<float> t;
  bool is_certain, has_t;
};
/// A ray from its least parameter on.
struct RayFromMin {
  const float (&o)[3], (&d)[3];
  float t_min;
};

inline bool is_open(const TreeView& tree, std::uint32_t id) {
  return is_in(tree.open.triangles, id);
}
/// Decides whether a ray arrives at the open side of triangle k of a block.
inline Within meets_open_side(const TreeView& tree, const TriangleBlock& block, int k,
                              const float* d) {
  const Within front = meets_front(block, k, d);
  if (!tree.open.is_back || front == Within::unsure) return front;
  return front == Within::yes ? Within::no : Within::yes;
}
inline bool is_masked(const TreeView& tree, std::uint32_t id) {
  return is_in(tree.masked, id);
}

/// Sets `best` to the hit of triangle k of a block if that hit is nearer and counts. `fallback`
/// decides uncertain cases.
template <class Slowly>
inline void consider(const TreeView& tree, const TriangleBlock& block, int k, const RayFromMin& ray,
                     const PossibleHit& hit, ClosestSoFar& best, const Slowly& fallback) {
  const Interval<float> t = hit.t;
  bool is_certain = hit.is_certain;
  if (!is_certain) {
    const Within within = within_edges(block, k, ray.o, ray.d);
    if (within == Within::no) return;
    is_certain = within == Within::yes && hit.has_t;
  }
  if (is_certain && t.lo > best.hi) return;
  bool is_nearer = is_certain && t.hi < best.lo && t.lo >= ray.t_min;
  if (is_nearer && is_masked(tree, block.id[k])) {
    const Visible visible = fallback.visible(block.id[k], weights_at_hit(block, k, ray.o, ray.d));
    if (visible == Visible::no) return;
    is_nearer = visible == Visible::yes;
  }
  if (is_nearer)
    best = {t.lo, t.hi, block.id[k]};
  else if (!(t.lo <= ray.t_min && is_left_behind(block, k, ray.o, ray.d)))
    fallback(block.id[k], best);
}

/// Sets `best` to the nearest hit among the lanes that a block's test has not rejected, if that hit
/// is nearer. Passes through open sides. With kAny, stops at the first hit. `fallback` decides the
/// uncertain lanes.
template <int N, bool kAny, class Slowly>
inline void meet_lanes(const TreeView& tree, const TriangleBlock& block, const BlockTest<N>& test,
                       const KernelRay& ray, ClosestSoFar& best, const Slowly& fallback) {
  for (Lanes lanes = test.maybe; lanes != 0; lanes &= lanes - 1) {
    const int lane = first_lane(lanes);
    const std::uint32_t id = block.id[lane];
    // A triangle can be in several leaves.
    if (id == best.id || id == ray.omitted_id) continue;
    if (is_open(tree, id)) {
      const Within passes = meets_open_side(tree, block, lane, ray.d);
      if (passes == Within::unsure) fallback(id, best);
      if (kAny && best.id != kNoPrimitive) return;
      if (passes != Within::no) continue;
    }
    consider(tree, block, lane, {ray.o, ray.d, ray.t_min},
             {.t = test.t(lane),
              .is_certain = (test.certain >> lane & 1U) != 0,
              .has_t = test.has_t(lane)},
             best, fallback);
    if (kAny && best.id != kNoPrimitive) return;
  }
}

/// Does the same for a block of an instance's mesh, of which `inner` has rejected some lanes.
template <int N, bool kAny, class Slowly>
inline void meet_instance_lanes(const TreeView& tree, const Instance& instance,
                                const TriangleBlock& block, const BlockTest<N>& inner,
                                const KernelRay& ray, ClosestSoFar& best, const Slowly& fallback) {
  // Most rays that leave an instance may hit the triangle that they leave, but nothing else nearby.
  const std::uint32_t omitted = ray.omitted_id - instance.first_id;
  const Lanes open = inner.maybe & ~lanes_within(block.id, omitted, omitted);
  if (open == 0) return;
  TriangleBlock placed;
  tree.scene_block(instance, block, placed);
  BlockTest<N> test;
  test.run(placed, ray, best.hi);
  test.maybe &= open;
  meet_lanes<N, kAny>(tree, placed, test, ray, best, fallback);
}

/// Tests all entries of a leaf against a ray and updates `best`, as meet_lanes does for one block.
template <int N, bool kAny, class Slowly>
inline void meet_leaf(const TreeView& tree, const Scope& scope, const KernelRay& ray,
                      const InnerRay& inner, ChildRef leaf, ClosestSoFar& best,
                      const Slowly& fallback) {
  const bool has_triangles = (leaf & child_ref::kKind) == child_ref::kTriangles;
  for_each_entry(leaf, [&](std::uint32_t i) {
    BlockTest<N> test;
    if (!has_triangles) {
      fallback(scope.first_id() + scope.others[i], best);
    } else if (scope.instance == nullptr) {
      test.run(scope.blocks[i], ray, best.hi);
      meet_lanes<N, kAny>(tree, scope.blocks[i], test, ray, best, fallback);
    } else {
      test.run(scope.blocks[i], inner, ray.t_begin, best.hi);
      if (test.maybe != 0)
        meet_instance_lanes<N, kAny>(tree, *scope.instance, scope.blocks[i], test, ray, best,
                                     fallback);
    }
    return kAny && best.id != kNoPrimitive;
  });
}

/// Considers every triangle of an instance, for rays that exceed the limits of enter().
template <class Slowly>
inline void consider_instance(const TreeView& tree, const Instance& instance, const KernelRay& ray,
                              ClosestSoFar& best, const Slowly& fallback) {
  for (std::uint32_t i = 0; i < tree.meshes[instance.mesh].triangles; ++i) {
    const std::uint32_t id = instance.first_id + i;
    if (id != ray.omitted_id) fallback(id, best);
  }
}

}  // namespace
}  // namespace microtrace
