#pragma once
/// Eight triangles against a ray by the signed volumes of docs/derivations.md, on float32 with an
/// error bound (docs/exactness.md derives it): a lane is certainly out, certainly in with t in an
/// interval, or left to the slow path.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

constexpr float kUnit = 0x1p-24F;   // unit roundoff of float32
constexpr float kTiny = 0x1p-100F;  // above all that underflow can add
constexpr float kFarthestHit =
    0x1p64F;  // coordinates up to 2^38 and d from 2^-20 on put every hit below 2^60

template <int N>
struct BlockTest {
  Lanes maybe = 0;    ///< lanes that are not certainly missed
  Lanes certain = 0;  ///< those of them that are certainly hit, t within [lo, hi]
  alignas(64) float lo[kWidth], hi[kWidth];

  /// Leaves out hits that are certainly beyond t_limit.
  BlockTest(const TriangleBlock& block, const KernelRay& ray, float t_limit) {
    const float limit = t_limit < kFarthestHit ? t_limit : kFarthestHit;
    for (int i = 0; i < kWidth; i += N) test(block, ray, limit, i);
  }

 private:
  void test(const TriangleBlock& block, const KernelRay& ray, float t_limit, int i) {
    using F = Float<N>;
    const F ax = load<N>(block.v0_x + i) - ray.o[0], ay = load<N>(block.v0_y + i) - ray.o[1],
            az = load<N>(block.v0_z + i) - ray.o[2];
    const F e1x = load<N>(block.e1_x + i), e1y = load<N>(block.e1_y + i),
            e1z = load<N>(block.e1_z + i);
    const F e2x = load<N>(block.e2_x + i), e2y = load<N>(block.e2_y + i),
            e2z = load<N>(block.e2_z + i);
    const float dx = ray.d[0], dy = ray.d[1], dz = ray.d[2];

    const F rx = ay * dz - az * dy, ry = az * dx - ax * dz, rz = ax * dy - ay * dx;
    const F nx = e1y * e2z - e1z * e2y, ny = e1z * e2x - e1x * e2z, nz = e1x * e2y - e1y * e2x;
    const F signed_size = nx * dx + ny * dy + nz * dz;
    const F size = magnitude(signed_size);
    // Each times the sign of signed_size.
    const F u = with_sign_of<N>(rx * e2x + ry * e2y + rz * e2z, signed_size);
    const F v = -with_sign_of<N>(rx * e1x + ry * e1y + rz * e1z, signed_size);
    const F height = with_sign_of<N>(nx * ax + ny * ay + nz * az, signed_size);

    const float em = block.largest_edge;
    const float size_error = 15 * kUnit * ray.d_sum * em * em + kTiny;
    const F a_sum = magnitude(ax) + magnitude(ay) + magnitude(az);
    const F edge_error = (a_sum + em) * (18 * kUnit * ray.d_sum * em) + kTiny;
    const F height_error = a_sum * (18 * kUnit * em * em) + kTiny;
    // How far inside all three edges; negative outside.
    const F within = lesser(lesser(u, v), size - (u + v));
    Lanes lanes = less_equal<N>(-edge_error, within);
    lanes &= less_equal<N>(height - size * t_limit, height_error + size_error * t_limit);
    lanes &= less_equal<N>(size * ray.t_begin - height, height_error + size_error * ray.t_begin);
    if (lanes == 0) return;
    maybe |= lanes << i;
    certain |= (lanes & less<N>(edge_error, within) & less<N>(all<N>(16 * size_error), size)) << i;
    const F t = height / size, distance = magnitude(t);
    const F radius = (height_error + distance * size_error) * 1.08F / size + distance * (8 * kUnit);
    store<N>(lo + i, t - radius);
    store<N>(hi + i, t + radius);
  }
};

/// f(entry) for the entries of a leaf until it returns true; whether it did.
template <class F>
inline bool for_each_entry(ChildRef leaf, const F& f) {
  const std::uint32_t first = (leaf & ~child_ref::kKind) >> 3U;
  const std::uint32_t count = (leaf & 7U) + 1;
  for (std::uint32_t i = first; i < first + count; ++i) {
    if (f(i)) return true;
  }
  return false;
}

/// One ray against a leaf: updates best to the leaf's nearest hit where that is nearer. With
/// kAny it stops at the first. slowly(id, best) is the slow path.
template <int N, bool kAny, class Slowly>
inline void meet_leaf(const TreeView& tree, const KernelRay& ray, ChildRef leaf, Best& best,
                      const Slowly& slowly) {
  const auto is_done = [&] { return kAny && best.id != kNoPrimitive; };
  if ((leaf & child_ref::kKind) != child_ref::kTriangles) {
    for_each_entry(leaf, [&](std::uint32_t i) {
      slowly(tree.others[i], best);
      return is_done();
    });
    return;
  }
  for_each_entry(leaf, [&](std::uint32_t index) {
    const TriangleBlock& block = tree.blocks[index];
    const BlockTest<N> test(block, ray, best.hi);
    for (Lanes lanes = test.maybe; lanes != 0; lanes &= lanes - 1) {
      const int lane = first_lane(lanes);
      const std::uint32_t id = block.id[lane];
      if (id == best.id) continue;  // large triangles are in several leaves
      const float lo = test.lo[lane], hi = test.hi[lane];
      if ((test.certain >> lane & 1U) != 0) {
        if (lo > best.hi) continue;
        if (hi < best.lo && lo >= ray.t_min) {
          best = {lo, hi, id};
          if (kAny) return true;
          continue;
        }
      }
      slowly(id, best);
      if (is_done()) return true;
    }
    return false;
  });
}

}  // namespace
}  // namespace microtrace
