#pragma once
/// Computes the rounded parameters t of known hits, several at a time. t = (A.n) / (d.n) is
/// evaluated in float64 with the error bound of TrianglePlaneFilter, which
/// src/accel/filters/triangle_filter.hpp derives.

#include "accel/filters/roundings.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

/// Three components, each a double or a SIMD vector of doubles.
template <class D>
struct Double3 {
  D x, y, z;

  friend Double3 operator-(const Double3& a, const Double3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
};

/// A triangle's plane relative to a ray's origin o: the normal n = e1 x e2 and the height A.n,
/// where A = a - o.
template <class D>
struct PlaneOfTriangle {
  Double3<D> n;
  D height, height_error;
  Double3<D> sum;  ///< the permanent of each component of n (see filter.hpp)

  PlaneOfTriangle(const Double3<D>& o, const Double3<D>& a, const Double3<D>& b,
                  const Double3<D>& c) {
    const Double3<D> from = a - o, e1 = b - a, e2 = c - a;
    const D left_x = e1.y * e2.z, left_y = e1.z * e2.x, left_z = e1.x * e2.y;
    const D right_x = e1.z * e2.y, right_y = e1.x * e2.z, right_z = e1.y * e2.x;
    sum = {magnitude(left_x) + magnitude(right_x), magnitude(left_y) + magnitude(right_y),
           magnitude(left_z) + magnitude(right_z)};
    n = {left_x - right_x, left_y - right_y, left_z - right_z};
    height = n.x * from.x + n.y * from.y + n.z * from.z;
    height_error =
        kHeightRoundings * kRounding *
            (sum.x * magnitude(from.x) + sum.y * magnitude(from.y) + sum.z * magnitude(from.z)) +
        kUnderflow;
  }
};

/// Writes N parameters t and returns the lanes whose t is certainly rounded correctly. size_error
/// bounds the error of d.n.
template <int N, class D>
inline Lanes round_t(const PlaneOfTriangle<D>& plane, const Double3<Double<N>>& d,
                     const D& size_error, float* t) {
  using V = Double<N>;
  const V size = plane.n.x * d.x + plane.n.y * d.y + plane.n.z * d.z;
  // Like quotient_result, but with only one division. t and the ends of its interval have three
  // more roundings than the quotient, so half of the 8 would suffice. If size exceeds 64 times its
  // error, 1 / (size - error) is at most 64/63 / size, which the factor 1.04 covers; requiring 32
  // times its error would suffice. The result for smaller sizes is too imprecise to round t.
  const V inverse = 1.0 / size, middle = plane.height * inverse, distance = magnitude(middle);
  V error = (plane.height_error + distance * size_error) * magnitude(inverse) * 1.04 +
            distance * (8 * kRounding) + kUnderflow;
  error = magnitude(size) > 64 * size_error ? error : V{} + __builtin_inf();
  float below[N], above[N];
  narrowed<N>(middle - error, below);
  narrowed<N>(middle + error, above);
  store<N>(t, load<N>(below) + 0.0F);  // -0 becomes 0
  return less_equal<N>(load<N>(above), load<N>(below));
}

template <int N>
inline Double3<Double<N>> widened3(const float (*p)[kHitBatch], int i) {
  return {widened<N>(p[0] + i), widened<N>(p[1] + i), widened<N>(p[2] + i)};
}
template <int N>
inline Double3<Double<N>> widened3(const float* const (&p)[3], int i) {
  return {widened<N>(p[0] + i), widened<N>(p[1] + i), widened<N>(p[2] + i)};
}

template <int N>
inline Double<N> size_error(const PlaneOfTriangle<Double<N>>& plane, const Double3<Double<N>>& d) {
  return kSlopeRoundings * kRounding *
             (plane.sum.x * magnitude(d.x) + plane.sum.y * magnitude(d.y) +
              plane.sum.z * magnitude(d.z)) +
         kUnderflow;
}

template <int N>
std::uint64_t round_t(HitBatch& hits) {
  std::uint64_t certain = 0;
  for (int i = 0; i < kHitBatch; i += N) {
    const PlaneOfTriangle<Double<N>> plane(widened3<N>(hits.o, i), widened3<N>(hits.a, i),
                                           widened3<N>(hits.b, i), widened3<N>(hits.c, i));
    const auto d = widened3<N>(hits.d, i);
    certain |= std::uint64_t{round_t<N>(plane, d, size_error<N>(plane, d), hits.t + i)} << i;
  }
  return certain;
}

/// Rounds t for the hits of a packet's rays.
template <int N>
class PacketRounding {
 public:
  PacketRounding(const TreeView& tree, const KernelPacket& packet, float* t)
      : tree_(tree), packet_(packet), t_(t), o_{packet.o[0], packet.o[1], packet.o[2]} {}

  std::uint64_t run() {
    std::uint64_t certain = 0;
    for (int i = 0; i < kPacketRays; i += kWidth) {
      const std::uint32_t* slots = packet_.best_slot + i;
      const Lanes hits = ~lanes_within(slots, kNoSlot, kNoSlot) & kAllLanes<kWidth>;
      if (hits == 0) continue;
      const int some = i + first_lane(hits);
      const std::uint32_t slot = packet_.best_slot[some];
      const bool is_one = slot != kPlacedSlot && (hits & ~lanes_within(slots, slot, slot)) == 0;
      for (int k = 0; k < kWidth; k += N)
        certain |= std::uint64_t{(is_one ? round_one(slot, i + k) : round_several(some, i + k)) &
                                 (hits >> k)}
                   << (i + k);
    }
    return certain;
  }

 private:
  // Rounds t for N rays that hit the same triangle, which is often also the triangle of the
  // preceding rays.
  Lanes round_one(std::uint32_t slot, int i) {
    if (slot != place_) {
      place_ = slot;
      const TriangleBlock& block = tree_.blocks[slot / kWidth];
      const std::uint32_t k = slot % kWidth;
      const auto vertex = [&](int corner) {
        return Double3<double>{coordinate(block, corner, k, 0), coordinate(block, corner, k, 1),
                               coordinate(block, corner, k, 2)};
      };
      plane_ = {o_, vertex(0), vertex(1), vertex(2)};
      const double sum = greater(greater(plane_.sum.x, plane_.sum.y), plane_.sum.z);
      size_error_ = kSlopeRoundings * kRounding * (sum * double{packet_.d_sum}) + kUnderflow;
    }
    return round_t<N>(plane_, d(i), size_error_, t_ + i);
  }

  // Rounds t for N rays that may hit different triangles. Rays without a hit use the triangle of
  // ray `other`.
  Lanes round_several(int other, int i) const {
    float a[3][N], b[3][N], c[3][N];
    for (int lane = 0; lane < N; ++lane) {
      const int ray = packet_.best_slot[i + lane] == kNoSlot ? other : i + lane;
      const std::uint32_t slot = packet_.best_slot[ray];
      for (int axis = 0; axis < 3; ++axis) {
        const auto vertex = [&](const float(&placed)[3][kHitBatch], int k) {
          return slot == kPlacedSlot
                     ? placed[axis][ray]
                     : coordinate(tree_.blocks[slot / kWidth], k, slot % kWidth, axis);
        };
        a[axis][lane] = vertex(packet_.placed.a, 0);
        b[axis][lane] = vertex(packet_.placed.b, 1);
        c[axis][lane] = vertex(packet_.placed.c, 2);
      }
    }
    const auto vertex = [](const float(&p)[3][N]) {
      return Double3<Double<N>>{widened<N>(p[0]), widened<N>(p[1]), widened<N>(p[2])};
    };
    const Double<N> zero{};
    const PlaneOfTriangle<Double<N>> plane({zero + o_.x, zero + o_.y, zero + o_.z}, vertex(a),
                                           vertex(b), vertex(c));
    return round_t<N>(plane, d(i), size_error<N>(plane, d(i)), t_ + i);
  }

  [[nodiscard]] Double3<Double<N>> d(int i) const {
    return {widened<N>(packet_.d[0] + i), widened<N>(packet_.d[1] + i),
            widened<N>(packet_.d[2] + i)};
  }

  const TreeView& tree_;
  const KernelPacket& packet_;
  float* t_;
  Double3<double> o_;
  std::uint32_t place_ = kNoSlot;
  PlaneOfTriangle<double> plane_{{}, {}, {}, {}};
  double size_error_ = 0;
};

template <int N>
std::uint64_t round_t_of_packet(const TreeView& tree, const KernelPacket& packet, float* t) {
  return PacketRounding<N>(tree, packet, t).run();
}

}  // namespace
}  // namespace microtrace
