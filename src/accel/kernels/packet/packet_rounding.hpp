#pragma once
/// Computes the rounded parameters t of a packet's hits. The planes of all triangles that are hit
/// are computed first, because most of them are hit by several rays.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/round_t.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

template <int N>
class PacketRounding {
 public:
  PacketRounding(const KernelPacket& packet, float* t) : packet_(packet), t_(t) {
    for (std::uint32_t i = 0; i < packet.hits.count; i += N) set_planes(i);
  }

  std::uint64_t run() const {
    std::uint64_t certain = 0;
    for (int i = 0; i < kPacketRays; i += N) {
      const Lanes hits = ~equal_to<N>(packet_.best_index + i, PacketHits::kNone) & kAllLanes<N>;
      if (hits != 0) certain |= std::uint64_t{round(i) & hits} << i;
    }
    return certain;
  }

 private:
  using D = Double<N>;

  // Sets the planes of the triangles [i, i + N).
  void set_planes(std::uint32_t i) {
    const D zero{};
    const Vector3<D> o{zero + packet_.o[0], zero + packet_.o[1], zero + packet_.o[2]};
    const PacketHits& hits = packet_.hits;
    const int first = static_cast<int>(i);
    const TrianglePlane<D> plane(o, widened3<N>(hits.a, first), widened3<N>(hits.b, first),
                                 widened3<N>(hits.c, first));
    // For each ray, the sum of |d| is at most d_sum.
    const D greatest = greater(greater(plane.sum.x, plane.sum.y), plane.sum.z);
    store_double<N>(n_[0] + i, plane.n.x);
    store_double<N>(n_[1] + i, plane.n.y);
    store_double<N>(n_[2] + i, plane.n.z);
    store_double<N>(height_ + i, plane.height);
    store_double<N>(height_error_ + i, plane.height_error);
    store_double<N>(size_error_ + i,
                    kSlopeRoundings * kRounding * (greatest * double{packet_.d_sum}) + kUnderflow);
  }

  // Rounds t for the rays [i, i + N). Rays without a hit get any result.
  [[nodiscard]] Lanes round(int i) const {
    const std::uint32_t* index = packet_.best_index + i;
    const auto of = [&](const double(&planes)[PacketHits::kMost]) {
      return looked_up<N>(planes, packet_.hits.count, index);
    };
    const PlaneFromOrigin<D> plane{
        .n = {of(n_[0]), of(n_[1]), of(n_[2])},
        .height = of(height_),
        .height_error = of(height_error_),
    };
    return round_t<N>(plane, widened3<N>(packet_.d, i), of(size_error_), t_ + i);
  }

  const KernelPacket& packet_;
  float* t_;
  // The planes of PacketHits.
  alignas(64) double n_[3][PacketHits::kMost];
  double height_[PacketHits::kMost], height_error_[PacketHits::kMost];
  double size_error_[PacketHits::kMost];
};

template <int N>
std::uint64_t round_t_of_packet(const KernelPacket& packet, float* t) {
  if (packet.hits.count == 0) return 0;
  return PacketRounding<N>(packet, t).run();
}

}  // namespace
}  // namespace microtrace
