#pragma once
/// Gathers the vertices of a block's triangles into vectors.

#include "accel/kernels/simd.hpp"
#include "accel/layout.hpp"

namespace microtrace {
namespace {

/// The vertices a, b and c of N triangles of a block, from slot i on, by axis.
template <int N>
struct BlockCorners {
  Float<N> of[3][3];

  /// Always inlined, so that the vectors stay in registers.
  __attribute__((always_inline)) BlockCorners(const TriangleBlock& block, int i) {
    for (int vertex = 0; vertex < 3; ++vertex) {
      for (int axis = 0; axis < 3; ++axis)
        of[vertex][axis] = picked<N>(block.vertices[axis], block.corners[vertex] + i);
    }
  }
};

/// The triangles of a block as the vertex a and the edges e1 and e2 from it, by axis and slot. They
/// are NaN in unused slots. N triangles are processed at a time.
template <int N>
struct BlockEdges {
  alignas(64) float a[3][kWidth];
  float e1[3][kWidth], e2[3][kWidth];

  explicit BlockEdges(const TriangleBlock& block) {
    for (int i = 0; i < kWidth; i += N) {
      const BlockCorners<N> corners(block, i);
      for (int axis = 0; axis < 3; ++axis) {
        const Float<N> first = corners.of[0][axis];
        store<N>(a[axis] + i, first);
        store<N>(e1[axis] + i, corners.of[1][axis] - first);
        store<N>(e2[axis] + i, corners.of[2][axis] - first);
      }
    }
  }
};

}  // namespace
}  // namespace microtrace
