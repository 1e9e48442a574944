#pragma once
/// Transforms boxes and triangles of a mesh's tree to the scene.
///
/// Vertices are computed by the operations of Placement::point, each of which is rounded. Rounded
/// sums and products with a constant are monotonic. So the least and greatest results for a box are
/// those at two of its corners, which the signs of the matrix select: all vertices in a box are in
/// the transformed box, without a margin.

#include "accel/instances/kernels/kernel.hpp"
#include "accel/kernels/block_corners.hpp"
#include "simd/vectors.hpp"

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// Returns row `axis` of the placement applied to (x, y, z), not yet rounded to float32.
template <int N>
inline Double<N> placed(const Instance& instance, int axis, const Double<N>& x, const Double<N>& y,
                        const Double<N>& z) {
  const double* const m = instance.scene_from_mesh + axis;
  return (m[0] * x + m[3] * y) + (m[6] * z + m[9]);
}

template <int N>
void scene_block(const Instance& instance, const TriangleBlock& from, TriangleBlock& to) {
  using F = Float<N>;
  for (unsigned i = 0; i < TriangleBlock::kVertices; i += N) {
    const Double<N> x = widened<N>(from.vertices[0] + i), y = widened<N>(from.vertices[1] + i),
                    z = widened<N>(from.vertices[2] + i);
    for (int axis = 0; axis < 3; ++axis)
      narrowed<N>(placed<N>(instance, axis, x, y, z), to.vertices[axis] + i);
  }
  const int second = instance.is_mirrored != 0 ? 2 : 1;
  __builtin_memcpy(to.corners[0], from.corners[0], kWidth);
  if (instance.is_mirrored != 0) {
    // The scene exchanges the vertices 1 and 2, and thus the two bits.
    for (std::uint8_t& corner : to.corners[0])
      corner =
          static_cast<std::uint8_t>((corner & 15U) | (corner & 16U) << 1U | (corner & 32U) >> 1U);
  }
  __builtin_memcpy(to.corners[1], from.corners[second], kWidth);
  __builtin_memcpy(to.corners[2], from.corners[3 - second], kWidth);
  F largest{}, product{};
  for (int i = 0; i < kWidth; i += N) {
    const BlockCorners<N> corners(to, i);
    F edges[2]{};
    for (int k = 0; k < 2; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        const F edge = corners.of[k + 1][axis] - corners.of[0][axis];
        edges[k] = greater(magnitude(edge), edges[k]);  // ignores the NaN of unused slots
      }
    }
    largest = greater(greater(edges[0], edges[1]), largest);
    product = greater(F(edges[0] * edges[1]), product);
  }
  to.largest_edge = to.edge_product = 0;
  float largest_lanes[N], product_lanes[N];
  store<N>(largest_lanes, largest);
  store<N>(product_lanes, product);
  for (int i = 0; i < N; ++i) {
    to.largest_edge = greater(largest_lanes[i], to.largest_edge);
    to.edge_product = greater(product_lanes[i], to.edge_product);
  }
  to.edge_product = to.edge_product * (1 + 0x1p-22F) + 0x1p-126F;
  for (int i = 0; i < kWidth; ++i) to.id[i] = from.id[i] + instance.first_id;
}

template <int N>
void scene_node(const Instance& instance, const WideNode& from, WideNode& to) {
  const float* const lo[3] = {from.lo_x, from.lo_y, from.lo_z};
  const float* const hi[3] = {from.hi_x, from.hi_y, from.hi_z};
  float* const least[3] = {to.lo_x, to.lo_y, to.lo_z};
  float* const greatest[3] = {to.hi_x, to.hi_y, to.hi_z};
  for (int axis = 0; axis < 3; ++axis) {
    const float *low[3], *high[3];
    for (int k = 0; k < 3; ++k) {
      const bool descends = instance.scene_from_mesh[3 * k + axis] < 0;
      low[k] = descends ? hi[k] : lo[k];
      high[k] = descends ? lo[k] : hi[k];
    }
    for (int i = 0; i < kWidth; i += N) {
      const auto at = [&](const float* const(&corner)[3], float* result) {
        narrowed<N>(placed<N>(instance, axis, widened<N>(corner[0] + i), widened<N>(corner[1] + i),
                              widened<N>(corner[2] + i)),
                    result + i);
      };
      at(low, least[axis]);
      at(high, greatest[axis]);
    }
  }
  for (int i = 0; i < kWidth; ++i) to.child[i] = from.child[i];
  // The transform of an empty box can be any box, or NaN.
  for (int i = 0; i < kWidth; ++i) {
    if (from.lo_x[i] <= from.hi_x[i]) continue;
    for (int axis = 0; axis < 3; ++axis) {
      least[axis][i] = __builtin_inff();
      greatest[axis][i] = -__builtin_inff();
    }
  }
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
