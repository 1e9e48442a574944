#pragma once
/// Tests eight triangles against a ray by the signed volumes of docs/derivations.md, in float32
/// with an error bound derived in docs/exactness.md. The result for each triangle is a certain
/// miss, a certain hit with t in an interval, or uncertain; the fallback decides uncertain lanes.

#include "accel/kernels/edge_test.hpp"
#include "accel/kernels/inner_ray.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

constexpr float kUnit = 0x1p-24F;        // unit roundoff of float32
constexpr float kTiny = 0x1p-100F;       // exceeds the total effect of underflow, 2^-107
constexpr float kFarthestHit = 0x1p64F;  // coordinates are at most 2^38 and the largest |d_i| is at
                                         // least 2^-20, so every hit is below 2^60

template <class F>
struct Interval {
  F lo, hi;
};

/// Returns the interval of t = height / size, where size must exceed 16 times its error. Half of
/// the factor 8 in the last term would suffice, because t and its ends have three roundings.
/// Requiring only 8 times the error would suffice too: such small sizes are sums with strong
/// cancellation, for which the errors of size and height are below 13/17 of their bounds.
template <class F, class G, class H>
inline Interval<F> interval(const F& height, const F& size, const G& height_error,
                            const H& size_error) {
  const F inverse = 1 / size, t = height * inverse, distance = t < F{} ? -t : t;
  const F radius =
      (height_error + distance * size_error) * inverse * 1.07F + distance * (8 * kUnit);
  return {t - radius, t + radius};
}

template <int N>
inline Float<N> lanes_of(float x) {
  return all<N>(x);
}
template <int N>
inline Float<N> lanes_of(const Float<N>& x) {
  return x;
}

constexpr float kNoSlack = -0.0F;  // compilers know that x + -0 is x, but not that x + 0 is x

/// Tests N triangles against one ray, or one triangle against N rays. RayPart is a vector of lanes
/// if there are N rays, otherwise a scalar.
template <int N, class RayPart>
struct VolumeTest {
  using F = Float<N>;
  Lanes maybe;    ///< lanes that are not certain misses
  Lanes certain;  ///< lanes of `maybe` that are certain hits
  F height, size, height_error;
  RayPart size_error;

  /// a is the vector from the ray's origin to the first vertex, e1 and e2 are the edges from that
  /// vertex. em is TriangleBlock::largest_edge, and m is TriangleBlock::edge_product. For slack see
  /// InnerRay.
  template <class TrianglePart>
  __attribute__((always_inline))
  VolumeTest(const F (&a)[3], const TrianglePart (&e1)[3], const TrianglePart (&e2)[3],
             const RayPart (&d)[3], float em, float m, const RayPart& d_sum, const RayPart& t_begin,
             const RayPart& t_limit, float slack = kNoSlack)
      : VolumeTest(a, e1, e2,
                   {e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2],
                    e1[0] * e2[1] - e1[1] * e2[0]},
                   d, em, m, d_sum, t_begin, t_limit, slack) {}

  /// n: e1 x e2. Always inlined, like BlockTest::run.
  template <class TrianglePart>
  __attribute__((always_inline))
  VolumeTest(const F (&a)[3], const TrianglePart (&e1)[3], const TrianglePart (&e2)[3],
             const TrianglePart (&n)[3], const RayPart (&d)[3], float em, float m,
             const RayPart& d_sum, const RayPart& t_begin, const RayPart& t_limit,
             float slack = kNoSlack) {
    const F rx = a[1] * d[2] - a[2] * d[1], ry = a[2] * d[0] - a[0] * d[2],
            rz = a[0] * d[1] - a[1] * d[0];
    const F signed_size = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
    size = magnitude(signed_size);
    // u, v and height are multiplied by the sign of signed_size.
    const F u = with_sign_of<N>(rx * e2[0] + ry * e2[1] + rz * e2[2], signed_size);
    const F v = -with_sign_of<N>(rx * e1[0] + ry * e1[1] + rz * e1[2], signed_size);
    height = with_sign_of<N>(n[0] * a[0] + n[1] * a[1] + n[2] * a[2], signed_size);

    const F a_sum = magnitude(a[0]) + magnitude(a[1]) + magnitude(a[2]) + slack;
    const F edge_error = (a_sum * em + m) * (15.01F * kUnit * d_sum) + kTiny;
    height_error = a_sum * (17.01F * kUnit * m) + kTiny;
    size_error = 15.01F * kUnit * d_sum * m + kTiny;
    // Positive if the ray passes inside all three edges, negative outside.
    const F within = lesser(lesser(u, v), size - (u + v));
    maybe = less_equal<N>(-edge_error, within);
    maybe &= less_equal<N>(height - size * t_limit, height_error + size_error * t_limit);
    // If signed_size may have the wrong sign, height may too, so the triangle is not certainly
    // behind the ray.
    maybe &= less_equal<N>(size * t_begin - height, height_error + size_error * t_begin) |
             less_equal<N>(size, lanes_of<N>(size_error));
    certain = maybe & less<N>(edge_error, within) & less<N>(lanes_of<N>(16 * size_error), size);
  }
};

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
      const F x = load<N>(block.a[0] + i), y = load<N>(block.a[1] + i), z = load<N>(block.a[2] + i);
      const F a[3] = {x - ray.o[0], y - ray.o[1], z - ray.o[2]};
      const F e1[3] = {load<N>(block.b[0] + i) - x, load<N>(block.b[1] + i) - y,
                       load<N>(block.b[2] + i) - z};
      const F e2[3] = {load<N>(block.c[0] + i) - x, load<N>(block.c[1] + i) - y,
                       load<N>(block.c[2] + i) - z};
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

inline std::uint32_t first_entry(ChildRef leaf) {
  return (leaf & ~child_ref::kKind) >> 3U;
}

/// Calls f(entry) for each entry of a leaf until f returns true. Returns true if f did.
template <class F>
inline bool for_each_entry(ChildRef leaf, const F& f) {
  const std::uint32_t first = first_entry(leaf);
  const std::uint32_t count = (leaf & 7U) + 1;
  for (std::uint32_t i = first; i < first + count; ++i) {
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

/// Sets `best` to the hit of triangle k of a block if that hit is nearer. `fallback` decides
/// uncertain cases.
template <class Slowly>
inline void consider(const TriangleBlock& block, int k, const RayFromMin& ray,
                     const PossibleHit& hit, ClosestSoFar& best, const Slowly& fallback) {
  const Interval<float> t = hit.t;
  bool is_certain = hit.is_certain;
  if (!is_certain) {
    const Within within = within_edges(block, k, ray.o, ray.d);
    if (within == Within::no) return;
    is_certain = within == Within::yes && hit.has_t;
  }
  if (is_certain && t.lo > best.hi) return;
  if (is_certain && t.hi < best.lo && t.lo >= ray.t_min)
    best = {t.lo, t.hi, block.id[k]};
  else if (!(t.lo <= ray.t_min && is_left_behind(block, k, ray.o, ray.d)))
    fallback(block.id[k], best);
}

inline bool is_open_front(const TreeView& tree, std::uint32_t id) {
  return tree.open_fronts != nullptr && (tree.open_fronts[id / 32] >> id % 32 & 1U) != 0;
}

/// Sets `best` to the nearest hit among the lanes that a block's test has not rejected, if that hit
/// is nearer. Passes through open fronts. With kAny, stops at the first hit. `fallback` decides the
/// uncertain lanes.
template <int N, bool kAny, class Slowly>
inline void meet_lanes(const TreeView& tree, const TriangleBlock& block, const BlockTest<N>& test,
                       const KernelRay& ray, ClosestSoFar& best, const Slowly& fallback) {
  for (Lanes lanes = test.maybe; lanes != 0; lanes &= lanes - 1) {
    const int lane = first_lane(lanes);
    const std::uint32_t id = block.id[lane];
    // A triangle can be in several leaves.
    if (id == best.id || id == ray.omitted_id) continue;
    if (is_open_front(tree, id)) {
      const Within front = meets_front(block, lane, ray.d);
      if (front == Within::unsure) fallback(id, best);
      if (kAny && best.id != kNoPrimitive) return;
      if (front != Within::no) continue;
    }
    consider(block, lane, {ray.o, ray.d, ray.t_min},
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
inline void consider_instance(const Instance& instance, const KernelRay& ray, ClosestSoFar& best,
                              const Slowly& fallback) {
  for (std::uint32_t i = 0; i < instance.mesh->triangles; ++i) {
    const std::uint32_t id = instance.first_id + i;
    if (id != ray.omitted_id) fallback(id, best);
  }
}

}  // namespace
}  // namespace microtrace
