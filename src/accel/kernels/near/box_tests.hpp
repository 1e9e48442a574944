#pragma once
/// Tests of nodes and triangles against small boxes.

#include "accel/kernels/block_test.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

struct ClosedBox {
  float lo[3], hi[3];
};

/// One of BoxQueries.
struct BoxQuery {
  ClosedBox box;
  std::uint32_t omitted_id;
  int plane_axis;
  float plane_at;
};

inline BoxQuery query_of(const BoxQueries& all, int i) {
  return {.box = {{all.lo[0][i], all.lo[1][i], all.lo[2][i]},
                  {all.hi[0][i], all.hi[1][i], all.hi[2][i]}},
          .omitted_id = all.omitted_id[i],
          .plane_axis = static_cast<int>(all.plane_axis[i]),
          .plane_at = all.plane_at[i]};
}

/// Returns the lanes in which [lo, hi] overlaps the box along an axis.
template <int N>
inline Lanes overlapping(const Float<N>& lo, const Float<N>& hi, const ClosedBox& box, int axis) {
  return less_equal<N>(lo, all<N>(box.hi[axis])) & less_equal<N>(all<N>(box.lo[axis]), hi);
}

template <int N>
inline Lanes touched_children(const WideNode& node, const ClosedBox& box) {
  Lanes lanes = 0;
  for (int i = 0; i < kWidth; i += N) {
    lanes |= (overlapping<N>(load<N>(node.lo_x + i), load<N>(node.hi_x + i), box, 0) &
              overlapping<N>(load<N>(node.lo_y + i), load<N>(node.hi_y + i), box, 1) &
              overlapping<N>(load<N>(node.lo_z + i), load<N>(node.hi_z + i), box, 2))
             << i;
  }
  return lanes;
}

/// Returns the boxes among N that overlap another box. No box may be empty.
template <int N>
inline Lanes overlapping(const float (&lo)[3], const float (&hi)[3], const Float<N> (&los)[3],
                         const Float<N> (&his)[3]) {
  // The differences have the signs of exact ones.
  Float<N> gap = greater(Float<N>(lo[0] - his[0]), Float<N>(los[0] - hi[0]));
  for (int axis = 1; axis < 3; ++axis)
    gap = greater(greater(Float<N>(lo[axis] - his[axis]), Float<N>(los[axis] - hi[axis])), gap);
  return less_equal<N>(gap, Float<N>{});
}

/// The bounding boxes of a block's triangles.
template <int N>
class BlockBounds {
 public:
  explicit BlockBounds(const TriangleBlock& block) {
    for (int k = 0; k < kParts; ++k) {
      const BlockCorners<N> corners(block, k * N);
      for (int axis = 0; axis < 3; ++axis) {
        const Float<N>&a = corners.of[0][axis], &b = corners.of[1][axis], &c = corners.of[2][axis];
        lo_[k][axis] = lesser(lesser(b, c), a);
        hi_[k][axis] = greater(greater(b, c), a);
      }
    }
  }

  /// Returns the triangles whose bounding boxes overlap the box. Unused slots are NaN and overlap
  /// nothing.
  [[nodiscard]] Lanes touched(const ClosedBox& box) const {
    Lanes lanes = 0;
    for (int k = 0; k < kParts; ++k) {
      Lanes touched = kAllLanes<N>;
      for (int axis = 0; axis < 3; ++axis)
        touched &= overlapping<N>(lo_[k][axis], hi_[k][axis], box, axis);
      lanes |= touched << k * N;
    }
    return lanes;
  }

 private:
  static constexpr int kParts = kWidth / N;
  Float<N> lo_[kParts][3], hi_[kParts][3];
};

/// Returns the triangles that the query omits.
template <int N>
inline Lanes omitted_triangles(const TriangleBlock& block, const BoxQuery& query) {
  Lanes lanes = lanes_within(block.id, query.omitted_id, query.omitted_id);
  if (query.plane_axis < 0) return lanes;
  const Float<N> plane = all<N>(query.plane_at);
  for (int i = 0; i < kWidth; i += N) {
    Lanes within = kAllLanes<N>;
    for (const auto& corner : block.corners) {
      const Float<N> x = picked<N>(block.vertices[query.plane_axis], corner + i);
      within &= less_equal<N>(x, plane) & less_equal<N>(plane, x);
    }
    lanes |= within << i;
  }
  return lanes;
}

/// Boxes as their centers and half extents, which are rounded up.
template <class F>
struct CenteredBox {
  F center[3], reach[3];

  CenteredBox(const F (&lo)[3], const F (&hi)[3]) {
    for (int k = 0; k < 3; ++k) {
      center[k] = 0.5F * lo[k] + 0.5F * hi[k];
      reach[k] = greater(hi[k] - center[k], center[k] - lo[k]) * (1 + 0x1p-20F);
    }
  }
};

/// Tests N triangles against one box, or one triangle against N boxes. Returns those of `lanes`
/// whose triangle may touch the box. The others certainly don't, because, seen along some axis, the
/// box is left of one edge and right of another. Long thin triangles often don't touch the box
/// although their bounding boxes overlap it. Let A and B be the vectors from the center to an
/// edge's ends, and r the half extents. The area A_i B_j - A_j B_i changes by at most r_i |B_j -
/// A_j| + r_j |B_i - A_i| within the box. Each of its terms has three roundings; the rounding of
/// the difference does not change its sign. Half of the eight units, and half of the margin of the
/// half extents for second-order roundings, would suffice.
template <int N, class Corner, class BoxPart>
inline Lanes without_clear(Lanes lanes, const Corner (&vertices)[3][3],
                           const CenteredBox<BoxPart>& box) {
  using F = Float<N>;
  F corners[3][3];
  for (int corner = 0; corner < 3; ++corner) {
    for (int axis = 0; axis < 3; ++axis)
      corners[corner][axis] = vertices[corner][axis] - box.center[axis];
  }
  for (int axis = 0; axis < 3 && lanes != 0; ++axis) {
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    Lanes any_positive = 0, any_negative = 0;
    for (int corner = 0; corner < 3; ++corner) {
      const F(&a)[3] = corners[corner];
      const F(&b)[3] = corners[(corner + 1) % 3];
      const F left = a[j] * b[k], right = a[k] * b[j], area = left - right;
      const F error = (magnitude(left) + magnitude(right)) * (8 * kUnit) +
                      (magnitude(a[k]) + magnitude(b[k])) * (box.reach[j] * (1 + 0x1p-20F)) +
                      (magnitude(a[j]) + magnitude(b[j])) * (box.reach[k] * (1 + 0x1p-20F)) + kTiny;
      any_positive |= less<N>(error, area);
      any_negative |= less<N>(area, -error);
    }
    lanes &= ~(any_positive & any_negative);
  }
  return lanes;
}

/// Adds a slot to the results of query i unless there are too many; returns whether there are.
inline bool adds_too_many(BoxQueries& queries, int i, std::uint32_t slot,
                          std::uint32_t id = kNoPrimitive) {
  int& count = queries.count[i];
  if (count == BoxQueries::kMost) count = -1;
  if (count >= 0) {
    queries.ids[i][count] = id;
    queries.slots[i][count++] = slot;
  }
  return count < 0;
}

}  // namespace
}  // namespace microtrace
