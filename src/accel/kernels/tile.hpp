#pragma once
/// 64 rays from one origin through the tree together: a node's eight boxes are first held against
/// the beam that the rays form, then each box that is left against the rays, only to know whether
/// one enters. What depends on the origin alone is computed once for each triangle, so that each
/// ray costs three dot products. Error bounds as in single_ray.hpp.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"
#include "accel/kernels/single_ray.hpp"
#include "accel/kernels/slabs.hpp"

namespace microtrace {
namespace {

template <int N>
class TileWalk {
 public:
  TileWalk(const TreeView& tree, KernelTile& tile, const TileSlowPath& slow)
      : tree_(tree), tile_(tile), slow_(slow) {
    update_limit();
  }

  void run() {
    StackEntry stack[kStackSize];
    int top = 0;
    stack[top++] = {tree_.root, tile_.least_t_begin};
    while (top > 0) {
      const StackEntry entry = stack[--top];
      if (entry.near > limit_) continue;
      if ((entry.child & child_ref::kKind) == 0) {
        top = push_children(tree_.nodes[entry.child], stack, top);
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
    F limit = load<N>(tile_.best_hi);
    for (int i = N; i < kTileRays; i += N) limit = greater(limit, load<N>(tile_.best_hi + i));
    limit_ = limit[0];
    for (int i = 1; i < N; ++i) limit_ = limit[i] > limit_ ? limit[i] : limit_;
  }

  // The children's planes through which rays enter and leave along an axis.
  struct Slab {
    const float *enter, *leave;
  };
  [[nodiscard]] Slab slab(const WideNode& node, int axis) const {
    const float* lo = axis == 0 ? node.lo_x : axis == 1 ? node.lo_y : node.lo_z;
    const float* hi = axis == 0 ? node.hi_x : axis == 1 ? node.hi_y : node.hi_z;
    return tile_.negative[axis] ? Slab{hi, lo} : Slab{lo, hi};
  }

  int push_children(const WideNode& node, StackEntry* stack, int top) const {
    alignas(64) float near[kWidth];
    Lanes entered = 0;
    for (int i = 0; i < kWidth; i += kNodeLanes) {
      B enter = all<kNodeLanes>(tile_.least_t_begin), leave = all<kNodeLanes>(limit_);
      for (int axis = 0; axis < 3; ++axis) {
        if (!tile_.common_sign[axis]) continue;
        const Slab planes = slab(node, axis);
        const B in = load<kNodeLanes>(planes.enter + i) - tile_.o[axis];
        const B out = load<kNodeLanes>(planes.leave + i) - tile_.o[axis];
        enter = greater(lesser(in * tile_.least_near[axis], in * tile_.greatest_near[axis]), enter);
        leave = lesser(greater(out * tile_.least_far[axis], out * tile_.greatest_far[axis]), leave);
      }
      entered |= less_equal<kNodeLanes>(enter, leave) << i;
      store<kNodeLanes>(near + i, enter);
    }
    const int first = top;
    for (; entered != 0; entered &= entered - 1) {
      const int lane = first_lane(entered);
      if (!some_ray_enters(node, lane)) continue;
      const StackEntry entry{node.child[lane], near[lane]};
      int place = top++;
      for (; place > first && stack[place - 1].near < entry.near; --place)
        stack[place] = stack[place - 1];
      stack[place] = entry;
    }
    return top;
  }

  [[nodiscard]] bool some_ray_enters(const WideNode& node, int lane) const {
    const float lo[3] = {node.lo_x[lane] - tile_.o[0], node.lo_y[lane] - tile_.o[1],
                         node.lo_z[lane] - tile_.o[2]};
    const float hi[3] = {node.hi_x[lane] - tile_.o[0], node.hi_y[lane] - tile_.o[1],
                         node.hi_z[lane] - tile_.o[2]};
    for (int i = 0; i < kTileRays; i += N) {
      F enter = load<N>(tile_.t_begin + i), leave = load<N>(tile_.best_hi + i);
      for (int axis = 0; axis < 3; ++axis) {
        const F near_factor = load<N>(tile_.near[axis] + i),
                far_factor = load<N>(tile_.far[axis] + i);
        if (tile_.common_sign[axis]) {
          const bool negative = tile_.negative[axis];
          enter = greater(near_factor * (negative ? hi[axis] : lo[axis]), enter);
          leave = lesser(far_factor * (negative ? lo[axis] : hi[axis]), leave);
        } else {
          // Which plane comes first depends on the ray; the sign of the factors tells.
          const F zero{};
          const F l = all<N>(lo[axis]), h = all<N>(hi[axis]);
          enter = greater(near_factor * (near_factor < zero ? h : l), enter);
          leave = lesser(far_factor * (far_factor < zero ? l : h), leave);
        }
      }
      if (less_equal<N>(enter, leave) != 0) return true;
    }
    return false;
  }

  void meet_leaf(ChildRef leaf) {
    if ((leaf & child_ref::kKind) == child_ref::kTriangles) {
      for_each_entry(leaf, [&](std::uint32_t i) {
        meet_block(tree_.blocks[i]);
        return false;
      });
    } else {
      for_each_entry(leaf, [&](std::uint32_t i) {
        slow_.consider_all(slow_.context, tree_.others[i], tile_);
        return false;
      });
    }
  }

  // What the triangles of a block look like from the origin.
  struct View {
    alignas(64) float u_x[kWidth], u_y[kWidth], u_z[kWidth];  // e2 x A
    float v_x[kWidth], v_y[kWidth], v_z[kWidth];              // A x e1
    float n_x[kWidth], n_y[kWidth], n_z[kWidth];              // e1 x e2
    float height[kWidth];                                     // n . A
    float error[kWidth], size_error[kWidth], height_error[kWidth];
    Lanes seen;  // triangles that are not certainly missed by every ray of the beam
  };

  struct Bounds {
    B least, greatest;
  };
  // Of the product of a vector with any direction of the beam.
  [[nodiscard]] Bounds over_beam(const B& x, const B& y, const B& z) const {
    const B* const v[3] = {&x, &y, &z};
    Bounds bounds{};
    for (int axis = 0; axis < 3; ++axis) {
      const B p = *v[axis] * tile_.least_d[axis], q = *v[axis] * tile_.greatest_d[axis];
      bounds.least += lesser(p, q);
      bounds.greatest += greater(p, q);
    }
    return bounds;
  }

  void view_from_origin(const TriangleBlock& block, View& view) const {
    constexpr int M = kNodeLanes;
    view.seen = 0;
    for (int i = 0; i < kWidth; i += M) {
      const B ax = load<M>(block.v0_x + i) - tile_.o[0], ay = load<M>(block.v0_y + i) - tile_.o[1],
              az = load<M>(block.v0_z + i) - tile_.o[2];
      const B e1x = load<M>(block.e1_x + i), e1y = load<M>(block.e1_y + i),
              e1z = load<M>(block.e1_z + i);
      const B e2x = load<M>(block.e2_x + i), e2y = load<M>(block.e2_y + i),
              e2z = load<M>(block.e2_z + i);
      const B ux = e2y * az - e2z * ay, uy = e2z * ax - e2x * az, uz = e2x * ay - e2y * ax;
      const B vx = ay * e1z - az * e1y, vy = az * e1x - ax * e1z, vz = ax * e1y - ay * e1x;
      const B nx = e1y * e2z - e1z * e2y, ny = e1z * e2x - e1x * e2z, nz = e1x * e2y - e1y * e2x;
      const B a_sum = magnitude(ax) + magnitude(ay) + magnitude(az);
      // Each triangle's own bounds: a huge one beside it would make a tiny one uncertain for every
      // ray. em and m as TriangleBlock's.
      const B e1 = greater(greater(magnitude(e1x), magnitude(e1y)), magnitude(e1z));
      const B e2 = greater(greater(magnitude(e2x), magnitude(e2y)), magnitude(e2z));
      const B m = e1 * e2 * (1 + 0x1p-22F);
      const B error = (a_sum * greater(e1, e2) + m) * (18 * kUnit * tile_.d_sum) + kTiny;

      // The beam is certainly outside an edge if u, v or size - u - v has one sign for all its
      // directions, and size the other. The bounds' own roundings are those of the rays' products;
      // the third form has three more, of its three parts.
      const Bounds u = over_beam(ux, uy, uz), v = over_beam(vx, vy, vz);
      const Bounds w = over_beam(nx - ux - vx, ny - uy - vy, nz - uz - vz);
      const Bounds size = over_beam(nx, ny, nz);
      const B lowest = lesser(lesser(u.greatest, v.greatest),
                              w.greatest);  // negative: outside, seen from one side
      const B highest =
          greater(greater(u.least, v.least), w.least);  // positive: outside, seen from the other
      const Lanes front = less_equal<M>(-error, size.greatest),
                  back = less_equal<M>(size.least, error);
      view.seen |=
          ((front & less_equal<M>(-2 * error, lowest)) | (back & less_equal<M>(highest, 2 * error)))
          << i;

      store<M>(view.u_x + i, ux);
      store<M>(view.u_y + i, uy);
      store<M>(view.u_z + i, uz);
      store<M>(view.v_x + i, vx);
      store<M>(view.v_y + i, vy);
      store<M>(view.v_z + i, vz);
      store<M>(view.n_x + i, nx);
      store<M>(view.n_y + i, ny);
      store<M>(view.n_z + i, nz);
      store<M>(view.height + i, nx * ax + ny * ay + nz * az);
      store<M>(view.error + i, error);
      store<M>(view.size_error + i, m * (15 * kUnit * tile_.d_sum) + kTiny);
      store<M>(view.height_error + i, a_sum * m * (18 * kUnit) + kTiny);
    }
  }

  void meet_block(const TriangleBlock& block) {
    View view;
    view_from_origin(block, view);
    for (Lanes lanes = view.seen; lanes != 0; lanes &= lanes - 1) {
      const int k = first_lane(lanes);
      for (int i = 0; i < kTileRays; i += N) meet_triangle(view, k, block.id[k], i);
    }
  }

  void meet_triangle(const View& view, int k, std::uint32_t id, int i) {
    const F dx = load<N>(tile_.d_x + i), dy = load<N>(tile_.d_y + i), dz = load<N>(tile_.d_z + i);
    const F zero{}, one = all<N>(1.0F);
    const F signed_size = dx * view.n_x[k] + dy * view.n_y[k] + dz * view.n_z[k];
    const F sign = signed_size < zero ? -one : one;
    const F size = signed_size * sign;
    const F u = (dx * view.u_x[k] + dy * view.u_y[k] + dz * view.u_z[k]) * sign;
    const F v = (dx * view.v_x[k] + dy * view.v_y[k] + dz * view.v_z[k]) * sign;
    const F within = lesser(lesser(u, v), size - (u + v));
    Lanes maybe = less_equal<N>(all<N>(-view.error[k]), within);
    if (maybe == 0) return;

    const float size_error = view.size_error[k];
    const F best_lo = load<N>(tile_.best_lo + i), best_hi = load<N>(tile_.best_hi + i);
    const F t_begin = load<N>(tile_.t_begin + i);
    const F limit = lesser(best_hi, all<N>(kFarthestHit));
    const F height = sign * view.height[k];
    maybe &= less_equal<N>(height - size * limit, limit * size_error + view.height_error[k]);
    maybe &= less_equal<N>(size * t_begin - height, t_begin * size_error + view.height_error[k]);
    if (maybe == 0) return;

    const auto [lo, hi] = interval(height, size, view.height_error[k], size_error);
    const Lanes certain =
        maybe & less<N>(all<N>(view.error[k]), within) & less<N>(all<N>(16 * size_error), size);
    const Lanes nearer =
        certain & less<N>(hi, best_lo) & less_equal<N>(load<N>(tile_.t_min + i), lo);
    const Lanes farther = certain & less<N>(best_hi, lo);
    if (nearer != 0) {
      store<N>(tile_.best_lo + i, select<N>(nearer, lo, best_lo));
      store<N>(tile_.best_hi + i, select<N>(nearer, hi, best_hi));
      for (Lanes lanes = nearer; lanes != 0; lanes &= lanes - 1)
        tile_.best_id[i + first_lane(lanes)] = id;
    }
    for (Lanes lanes = maybe & ~nearer & ~farther; lanes != 0; lanes &= lanes - 1) {
      const int ray = i + first_lane(lanes);
      // A triangle that was split among leaves comes more than once.
      if (tile_.best_id[ray] != id) decide_slowly(ray, id);
    }
  }

  void decide_slowly(int ray, std::uint32_t id) {
    Best best{tile_.best_lo[ray], tile_.best_hi[ray], tile_.best_id[ray]};
    slow_.consider(slow_.context, ray, id, best);
    tile_.best_lo[ray] = best.lo;
    tile_.best_hi[ray] = best.hi;
    tile_.best_id[ray] = best.id;
  }

  const TreeView& tree_;
  KernelTile& tile_;
  const TileSlowPath& slow_;
  float limit_ = 0;  // no hit beyond this can be the nearest of any ray
};

template <int N>
void closest_of_tile(const TreeView& tree, KernelTile& tile, const TileSlowPath& slow) {
  TileWalk<N>(tree, tile, slow).run();
}

}  // namespace
}  // namespace microtrace
