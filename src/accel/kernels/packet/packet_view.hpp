#pragma once
/// A block's triangles relative to the common origin of a packet's rays, and which groups of rays
/// may hit each of them.

#include "accel/kernels/block_corners.hpp"
#include "accel/kernels/block_test.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/packet/packet_boxes.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

/// Processes N triangles at a time, N <= kWidth.
template <int N>
struct PacketView {
  // If n . d has the same sign for all directions of the beam, the following values are multiplied
  // by this sign.
  alignas(64) float u[3][kWidth];  ///< e2 x A
  float v[3][kWidth];              ///< A x e1
  float n[3][kWidth];              ///< e1 x e2
  float height[kWidth];            ///< n . A
  float error[kWidth], size_error[kWidth], height_error[kWidth];
  Lanes seen[kGroups]{};  ///< for each group, the triangles that its rays do not certainly miss
  Lanes two_sided = 0;    ///< triangles for which the sign of n . d is not the same for all rays
  /// Triangles that have their front or their back on the side of the origin, where rays arrive.
  Lanes fronts = 0, backs = 0;

  PacketView(const TriangleBlock& block, const KernelPacket& packet, Groups groups) {
    for (int i = 0; i < kWidth; i += N) look_at(block, packet, groups, i);
  }

 private:
  using F = Float<N>;
  struct Vector {
    F x, y, z;
  };
  struct Range {
    F middle, radius;
  };

  static Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  // Returns the range of a . d over all directions d of the beam.
  static Range over(const Beam& beam, const Vector& a) {
    return {a.x * beam.center[0] + a.y * beam.center[1] + a.z * beam.center[2],
            magnitude(a.x) * beam.radius[0] + magnitude(a.y) * beam.radius[1] +
                magnitude(a.z) * beam.radius[2]};
  }
  static F greatest(const Beam& beam, const Vector& a) {
    const Range range = over(beam, a);
    return range.middle + range.radius;
  }
  static Vector with_sign_of(const Vector& a, const F& b) {
    return {microtrace::with_sign_of<N>(a.x, b), microtrace::with_sign_of<N>(a.y, b),
            microtrace::with_sign_of<N>(a.z, b)};
  }
  static void store(float (&to)[3][kWidth], int i, const Vector& a) {
    microtrace::store<N>(to[0] + i, a.x);
    microtrace::store<N>(to[1] + i, a.y);
    microtrace::store<N>(to[2] + i, a.z);
  }

  void look_at(const TriangleBlock& block, const KernelPacket& packet, Groups groups, int i) {
    const BlockCorners<N> corners(block, i);
    const auto& [first, second, third] = corners.of;
    const Vector a{first[0] - packet.o[0], first[1] - packet.o[1], first[2] - packet.o[2]};
    const Vector e1{second[0] - first[0], second[1] - first[1], second[2] - first[2]};
    const Vector e2{third[0] - first[0], third[1] - first[1], third[2] - first[2]};
    Vector normal = cross(e1, e2), p = cross(e2, a), q = cross(a, e1);
    F h = normal.x * a.x + normal.y * a.y + normal.z * a.z;
    // Each triangle has its own error bounds. With a common bound, one huge triangle in the block
    // would make a tiny one undecided for every ray. em1 and em2 correspond to
    // TriangleBlock::largest_edge, and m to edge_product.
    const F a_sum = magnitude(a.x) + magnitude(a.y) + magnitude(a.z);
    const F em1 = greater(greater(magnitude(e1.x), magnitude(e1.y)), magnitude(e1.z));
    const F em2 = greater(greater(magnitude(e2.x), magnitude(e2.y)), magnitude(e2.z));
    const F m = em1 * em2 * (1 + 0x1p-22F);
    const F bound = (a_sum * greater(em1, em2) + m) * (15.01F * kUnit * packet.d_sum) + kTiny;
    const F size_bound = m * (15.01F * kUnit * packet.d_sum) + kTiny;

    const F height_bound = a_sum * m * (17.01F * kUnit) + kTiny;
    fronts |= less<N>(h, -height_bound) << i;
    backs |= less<N>(height_bound, h) << i;

    const Range size = over(packet.beam, normal);
    // Computing the range takes as many roundings as n . d for one ray. Half of this bound would
    // suffice, because center and radius together do not exceed the largest |d|.
    const Lanes both = less_equal<N>(magnitude(size.middle) - size.radius, 2 * size_bound);
    normal = with_sign_of(normal, size.middle);
    p = with_sign_of(p, size.middle);
    q = with_sign_of(q, size.middle);
    h = microtrace::with_sign_of<N>(h, size.middle);
    two_sided |= both << i;

    // A group certainly misses a triangle if u, v or size - u - v is negative for all directions of
    // the group. The third form has nine roundings, for which 18 units would suffice; three times
    // the bound is more than enough.
    const Vector r{normal.x - p.x - q.x, normal.y - p.y - q.y, normal.z - p.z - q.z};
    for_each_group(groups, [&](int group) {
      const auto& [center, radius] = packet.group_beams;
      const Beam beam{.center = {center[0][group], center[1][group], center[2][group]},
                      .radius = {radius[0][group], radius[1][group], radius[2][group]}};
      const F within = lesser(lesser(greatest(beam, p), greatest(beam, q)), greatest(beam, r));
      seen[group] |= (both | less_equal<N>(-3 * bound, within)) << i;
    });

    store(u, i, p);
    store(v, i, q);
    store(n, i, normal);
    microtrace::store<N>(height + i, h);
    microtrace::store<N>(error + i, bound);
    microtrace::store<N>(size_error + i, size_bound);
    microtrace::store<N>(height_error + i, height_bound);
  }
};

}  // namespace
}  // namespace microtrace
