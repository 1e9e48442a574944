#pragma once
/// Visits the leaves of a tree that a ray may meet, in no particular order, for queries that need
/// all hits. In float64, so that any valid ray is within its limits.

#include "accel/build/tree.hpp"
#include "accel/layout.hpp"

#include <microtrace/ray.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace microtrace {

class RaySearch {
 public:
  RaySearch(const Tree& tree, const Ray& ray) : tree_(&tree), t_min_(ray.t_min), t_max_(ray.t_max) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      o_[axis] = ray.o[static_cast<int>(axis)];
      d_[axis] = ray.d[static_cast<int>(axis)];
    }
  }

  /// Calls block(triangle block, lanes) with the set of used lanes of each block of triangles, and
  /// other(id) for each other primitive, that is in a box which the ray meets, or that is in no
  /// box. Primitives may be visited several times.
  template <class OnBlock, class OnOther>
  void for_each(const OnBlock& block, const OnOther& other) const {
    for (const PrimitiveId id : tree_->unbounded) other(id);
    if (tree_->blocks.empty() && tree_->others.empty()) return;
    std::array<ChildRef, kStack> stack;
    std::size_t size = 0;
    stack[size++] = tree_->root;
    while (size > 0) {
      const ChildRef next = stack[--size];
      if ((next & child_ref::kKind) == 0) {
        const WideNode& node = tree_->nodes[next];
        for (unsigned lanes = entered(node); lanes != 0; lanes &= lanes - 1)
          stack[size++] = node.child[std::countr_zero(lanes)];
        continue;
      }
      const std::uint32_t first = (next & ~child_ref::kKind) >> 3U, end = first + (next & 7U) + 1;
      const bool are_triangles = (next & child_ref::kKind) == child_ref::kTriangles;
      for (std::uint32_t i = first; i < end; ++i) {
        if (are_triangles) {
          const TriangleBlock& triangles = tree_->blocks[i];
          if (const unsigned lanes = passed(triangles); lanes != 0) block(triangles, lanes);
        } else {
          other(tree_->others[i]);
        }
      }
    }
  }

 private:
  static constexpr std::size_t kStack = kMaxDepth * (kWidth - 1) + kWidth;
  static constexpr double kUnit = 0x1p-53;

  /// The children whose boxes the ray meets, and perhaps others. A distance (plane - o) / d has
  /// three roundings, and no result under- or overflows. The box is met if the greatest entry is at
  /// most the least exit; the entry is not negative, so enlarging the exit by 16 units is enough
  /// for the roundings of both.
  [[nodiscard]] unsigned entered(const WideNode& node) const {
    const float* const lo[3] = {node.lo_x, node.lo_y, node.lo_z};
    const float* const hi[3] = {node.hi_x, node.hi_y, node.hi_z};
    std::array<double, kWidth> enter, leave;
    enter.fill(t_min_);
    leave.fill(t_max_);
    unsigned lanes = (1U << kWidth) - 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double o = o_[axis], d = d_[axis];
      if (d == 0) {
        for (int i = 0; i < kWidth; ++i)
          if (!(lo[axis][i] <= o && o <= hi[axis][i])) lanes &= ~(1U << static_cast<unsigned>(i));
        continue;
      }
      const double inverse = 1 / d;
      const float* const near = d < 0 ? hi[axis] : lo[axis];
      const float* const far = d < 0 ? lo[axis] : hi[axis];
      for (std::size_t i = 0; i < kWidth; ++i) {
        const double in = (near[i] - o) * inverse, out = (far[i] - o) * inverse;
        enter[i] = in > enter[i] ? in : enter[i];
        leave[i] = out < leave[i] ? out : leave[i];
      }
    }
    unsigned met = 0;
    for (std::size_t i = 0; i < kWidth; ++i)
      met |= static_cast<unsigned>(enter[i] <= leave[i] * (1 + 16 * kUnit)) << i;
    return met & lanes;
  }

  /// The triangles of a block that the ray's line does not certainly miss. With A, B, C from the
  /// origin to the vertices, two of d.(B x C), d.(C x A), d.(A x B) with opposite signs are a miss.
  /// Each has six terms of at most |d_k| m^2, where m is the largest |component| of A, B, C. A term
  /// has seven roundings: two of its factors, two products, the difference, two sums. The bound
  /// allows eight, which covers its own roundings.
  [[nodiscard]] unsigned passed(const TriangleBlock& block) const {
    const double d_sum = std::abs(d_[0]) + std::abs(d_[1]) + std::abs(d_[2]);
    std::array<unsigned char, kWidth> keeps;
    for (std::size_t i = 0; i < kWidth; ++i) {
      const double ax = block.a_x[i] - o_[0], ay = block.a_y[i] - o_[1], az = block.a_z[i] - o_[2];
      const double bx = block.b_x[i] - o_[0], by = block.b_y[i] - o_[1], bz = block.b_z[i] - o_[2];
      const double cx = block.c_x[i] - o_[0], cy = block.c_y[i] - o_[1], cz = block.c_z[i] - o_[2];
      const auto volume = [this](double px, double py, double pz, double qx, double qy, double qz) {
        return d_[0] * (py * qz - pz * qy) + d_[1] * (pz * qx - px * qz) +
               d_[2] * (px * qy - py * qx);
      };
      const auto larger = [](double x, double y) { return x > y ? x : y; };
      const auto size = [&](double x, double y, double z) {
        return larger(larger(std::abs(x), std::abs(y)), std::abs(z));
      };
      const double u = volume(bx, by, bz, cx, cy, cz), v = volume(cx, cy, cz, ax, ay, az),
                   w = volume(ax, ay, az, bx, by, bz);
      const double m = larger(larger(size(ax, ay, az), size(bx, by, bz)), size(cx, cy, cz));
      const double error = 2 * 8 * kUnit * d_sum * (m * m);
      const double greatest = larger(larger(u, v), w), least = -larger(larger(-u, -v), -w);
      // False for the NaN of an unused lane, which is also in a.
      const bool is_used = ax == ax;
      keeps[i] = static_cast<unsigned char>(is_used & !((greatest > error) & (least < -error)));
    }
    unsigned lanes = 0;
    for (std::size_t i = 0; i < kWidth; ++i) lanes |= unsigned{keeps[i]} << i;
    return lanes;
  }

  const Tree* tree_;
  double t_min_, t_max_;
  std::array<double, 3> o_{}, d_{};
};

/// The triangle in a lane of a block, with the vertices in another order than the scene's.
[[nodiscard]] inline Triangle triangle_in(const TriangleBlock& block, std::size_t lane) {
  return {.a = {block.a_x[lane], block.a_y[lane], block.a_z[lane]},
          .b = {block.b_x[lane], block.b_y[lane], block.b_z[lane]},
          .c = {block.c_x[lane], block.c_y[lane], block.c_z[lane]}};
}

}  // namespace microtrace
