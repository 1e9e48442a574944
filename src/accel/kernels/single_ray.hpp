#pragma once
/// One ray through the eight-wide tree, nearest children first.
///
/// Triangles are tested by the signed volumes of docs/derivations.md on float32 with an error bound
/// (docs/exactness.md derives it): a lane is certainly out, certainly in with t in an interval, or
/// left to the slow path.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"
#include "accel/kernels/slabs.hpp"

namespace microtrace {
namespace {

constexpr float kUnit = 0x1p-24F;   // unit roundoff of float32
constexpr float kTiny = 0x1p-100F;  // above all that underflow can add
constexpr float kFarthestHit =
    0x1p64F;  // coordinates up to 2^38 and d from 2^-20 on put every hit below 2^60

/// Eight triangles against a ray, as far as all lanes go together.
template <int N>
struct BlockTest {
  Lanes maybe = 0;  ///< lanes that are not certainly missed
  alignas(64) float inside[kWidth], size[kWidth], height[kWidth], edge_error[kWidth],
      height_error[kWidth];
  float size_error = 0;

  BlockTest(const TriangleBlock& block, const KernelRay& ray, float t_limit) {
    const float em = block.largest_edge;
    size_error = 15 * kUnit * ray.d_sum * em * em + kTiny;
    for (int i = 0; i < kWidth; i += N) test(block, ray, t_limit, i);
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
    const F zero{};
    const F one = all<N>(1.0F), sign = signed_size < zero ? -one : one;
    const F d_size = signed_size * sign;
    const F u = (rx * e2x + ry * e2y + rz * e2z) * sign,
            v = (rx * e1x + ry * e1y + rz * e1z) * -sign;
    const F t = (nx * ax + ny * ay + nz * az) * sign;

    const float em = block.largest_edge;
    const F a_sum = magnitude(ax) + magnitude(ay) + magnitude(az);
    const F error = (a_sum + em) * (18 * kUnit * ray.d_sum * em) + kTiny;
    const F t_error = a_sum * (18 * kUnit * em * em) + kTiny;
    // How far inside all three edges; negative outside.
    const F within = lesser(lesser(u, v), d_size - (u + v));
    Lanes lanes = less_equal<N>(-error, within);
    lanes &= less_equal<N>(t - d_size * t_limit, t_error + size_error * t_limit);
    lanes &= less_equal<N>(d_size * ray.t_begin - t, t_error + size_error * ray.t_begin);
    if (lanes == 0) return;
    maybe |= lanes << i;
    store<N>(inside + i, within);
    store<N>(size + i, d_size);
    store<N>(height + i, t);
    store<N>(edge_error + i, error);
    store<N>(height_error + i, t_error);
  }
};

struct Interval {
  float lo, hi;
};

/// Whether a lane is certainly hit, and where.
template <int N>
inline bool is_certain(const BlockTest<N>& test, int lane, Interval& t) {
  const float size = test.size[lane];
  if (!(test.inside[lane] > test.edge_error[lane]) || !(size > 16 * test.size_error)) return false;
  const float quotient = test.height[lane] / size;
  const float distance = __builtin_fabsf(quotient);
  const float radius =
      1.08F * (test.height_error[lane] + distance * test.size_error) / size + 8 * kUnit * distance;
  t = {quotient - radius, quotient + radius};
  return true;
}

struct StackEntry {
  ChildRef child;
  float near;
};
constexpr int kStackSize = 64 * (kWidth - 1) + 1;  // the builder keeps trees below 64 levels

/// Pushes the children that the ray enters before `limit`, the nearest last.
template <int N>
inline int push_children(const WideNode& node, const KernelRay& ray, float limit, StackEntry* stack,
                         int top) {
  using F = Float<N>;
  alignas(64) float near[kWidth];
  Lanes entered = 0;
  const float* x[2] = {node.lo_x, node.hi_x};
  const float* y[2] = {node.lo_y, node.hi_y};
  const float* z[2] = {node.lo_z, node.hi_z};
  for (int i = 0; i < kWidth; i += N) {
    const F near_x = (load<N>(x[ray.negative[0]] + i) - ray.o[0]) * ray.near_factor[0];
    const F near_y = (load<N>(y[ray.negative[1]] + i) - ray.o[1]) * ray.near_factor[1];
    const F near_z = (load<N>(z[ray.negative[2]] + i) - ray.o[2]) * ray.near_factor[2];
    const F far_x = (load<N>(x[!ray.negative[0]] + i) - ray.o[0]) * ray.far_factor[0];
    const F far_y = (load<N>(y[!ray.negative[1]] + i) - ray.o[1]) * ray.far_factor[1];
    const F far_z = (load<N>(z[!ray.negative[2]] + i) - ray.o[2]) * ray.far_factor[2];
    // 0 * infinity is NaN, and means no limit: lesser and greater drop a NaN on their left.
    const F enter = greater(near_x, greater(near_y, greater(near_z, all<N>(ray.t_begin))));
    const F leave = lesser(far_x, lesser(far_y, lesser(far_z, all<N>(limit))));
    entered |= less_equal<N>(enter, leave) << i;
    store<N>(near + i, enter);
  }
  const int first = top;
  for (; entered != 0; entered &= entered - 1) {
    const int lane = first_lane(entered);
    const StackEntry entry{node.child[lane], near[lane]};
    int place = top++;
    for (; place > first && stack[place - 1].near < entry.near; --place)
      stack[place] = stack[place - 1];
    stack[place] = entry;
  }
  return top;
}

/// Walks the tree; leaf(ref) is called for every leaf whose box the ray enters before limit(),
/// nearest first, until it returns true.
template <int N, class Limit, class Leaf>
inline bool walk(const TreeView& tree, const KernelRay& ray, const Limit& limit, const Leaf& leaf) {
  StackEntry stack[kStackSize];
  int top = 0;
  stack[top++] = {tree.root, ray.t_begin};
  while (top > 0) {
    const StackEntry entry = stack[--top];
    if (entry.near > limit()) continue;
    if ((entry.child & child_ref::kKind) == 0) {
      top = push_children<N>(tree.nodes[entry.child], ray, limit(), stack, top);
    } else if (leaf(entry.child)) {
      return true;
    }
  }
  return false;
}

template <class F>
inline bool for_each_entry(ChildRef leaf, const F& f) {
  const std::uint32_t first = (leaf & ~child_ref::kKind) >> 3U;
  const std::uint32_t count = (leaf & 7U) + 1;
  for (std::uint32_t i = first; i < first + count; ++i) {
    if (f(i)) return true;
  }
  return false;
}

template <int N>
void closest(const TreeView& tree, KernelRay ray, const SlowPath& slow, Best& best) {
  prepare_ray(ray);
  const auto block = [&](std::uint32_t index) {
    const TriangleBlock& triangles = tree.blocks[index];
    const BlockTest<N> test(triangles, ray, best.hi < kFarthestHit ? best.hi : kFarthestHit);
    for (Lanes lanes = test.maybe; lanes != 0; lanes &= lanes - 1) {
      const int lane = first_lane(lanes);
      Interval t;
      if (is_certain(test, lane, t)) {
        if (t.lo > best.hi) continue;
        if (t.hi < best.lo && t.lo >= ray.t_min) {
          best = {t.lo, t.hi, triangles.id[lane]};
          continue;
        }
      }
      slow.consider(slow.context, triangles.id[lane], best);
    }
    return false;
  };
  walk<N>(
      tree, ray, [&] { return best.hi; },
      [&](ChildRef leaf) {
        if ((leaf & child_ref::kKind) == child_ref::kTriangles) return for_each_entry(leaf, block);
        return for_each_entry(leaf, [&](std::uint32_t i) {
          slow.consider(slow.context, tree.others[i], best);
          return false;
        });
      });
}

template <int N>
bool any(const TreeView& tree, KernelRay ray, const SlowPath& slow) {
  prepare_ray(ray);
  const auto slowly = [&](std::uint32_t id) {
    Best best{ray.t_max, ray.t_max, kNoPrimitive};
    slow.consider(slow.context, id, best);
    return best.id != kNoPrimitive;
  };
  const auto block = [&](std::uint32_t index) {
    const TriangleBlock& triangles = tree.blocks[index];
    const BlockTest<N> test(triangles, ray, ray.t_max < kFarthestHit ? ray.t_max : kFarthestHit);
    for (Lanes lanes = test.maybe; lanes != 0; lanes &= lanes - 1) {
      const int lane = first_lane(lanes);
      Interval t;
      if (is_certain(test, lane, t) && t.lo >= ray.t_min && t.hi <= ray.t_max) return true;
      if (slowly(triangles.id[lane])) return true;
    }
    return false;
  };
  return walk<N>(
      tree, ray, [&] { return ray.t_max; },
      [&](ChildRef leaf) {
        if ((leaf & child_ref::kKind) == child_ref::kTriangles) return for_each_entry(leaf, block);
        return for_each_entry(leaf, [&](std::uint32_t i) { return slowly(tree.others[i]); });
      });
}

}  // namespace
}  // namespace microtrace
