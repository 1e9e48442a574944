#pragma once
/// Fills a packet with rays: transposes the rays to one array per component and computes the beam
/// around them.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/packet/packet_boxes.hpp"
#include "accel/kernels/simd.hpp"
#include "accel/kernels/slabs.hpp"

#include <cstddef>

namespace microtrace {
namespace {

/// Transposes an 8 x 8 matrix.
inline void transpose(Float<8> (&m)[8]) {
  Float<8> pairs[8], fours[8];
  for (int i = 0; i < 8; i += 2) {
    pairs[i] = __builtin_shufflevector(m[i], m[i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    pairs[i + 1] = __builtin_shufflevector(m[i], m[i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  for (int i = 0; i < 8; i += 4) {
    for (int k = 0; k < 2; ++k) {
      const Float<8>&p = pairs[i + k], &q = pairs[i + k + 2];
      fours[i + 2 * k] = __builtin_shufflevector(p, q, 0, 1, 8, 9, 4, 5, 12, 13);
      fours[i + 2 * k + 1] = __builtin_shufflevector(p, q, 2, 3, 10, 11, 6, 7, 14, 15);
    }
  }
  for (int i = 0; i < 4; ++i) {
    m[i] = __builtin_shufflevector(fours[i], fours[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    m[i + 4] = __builtin_shufflevector(fours[i], fours[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

/// Transposes rays to one array per component. Returns false if the rays have different origins.
inline bool read_rows(const float* rays, KernelPacket& packet) {
  Float<8> differences{};
  for (int i = 0; i < kPacketRays; i += 8) {
    Float<8> column[8];
    for (int k = 0; k < 8; ++k) {
      const std::ptrdiff_t ray = i + k < packet.count ? packet.order[i + k] : packet.count - 1;
      column[k] = load<8>(rays + 8 * ray);
    }
    transpose(column);
    for (int axis = 0; axis < 3; ++axis) {
      differences = differences + magnitude(column[axis] - packet.o[axis]);
      store<8>(packet.d[axis] + i, column[4 + axis]);
    }
    store<8>(packet.t_min + i, column[3]);
    store<8>(packet.best_lo + i, column[7]);
    store<8>(packet.best_hi + i, column[7]);
  }
  // The difference of two different float32 numbers is never 0. The comparison is false for NaN.
  return less_equal<8>(differences, Float<8>{}) == kAllLanes<8>;
}

inline Beam beam_between(const float (&least)[3], const float (&greatest)[3]) {
  Beam beam;
  for (int axis = 0; axis < 3; ++axis) {
    const float center = 0.5F * least[axis] + 0.5F * greatest[axis];
    beam.center[axis] = center;
    beam.radius[axis] =
        greater(greatest[axis] - center, center - least[axis]) * (1 + 0x1p-22F) + 0x1p-126F;
  }
  return beam;
}

template <int N>
bool fill_packet(const float* rays, int count, KernelPacket& packet) {
  using F = Float<N>;
  packet.count = count;
  for (int axis = 0; axis < 3; ++axis) {
    packet.o[axis] = packet.boxes.o_of_lo[axis] = packet.boxes.o_of_hi[axis] = rays[axis];
    if (!(__builtin_fabsf(rays[axis]) <= kFarthestCoordinate)) return false;
  }
  if (!read_rows(rays, packet)) return false;
  // The caller's next packet of rays is usually stored directly after this one.
  constexpr int kFloats = 8 * kPacketRays;
  for (int i = kFloats; i < 2 * kFloats; i += 16) __builtin_prefetch(rays + i);
  __builtin_memset(packet.best_id, 0xff, sizeof packet.best_id);
  __builtin_memset(packet.best_slot, 0xff, sizeof packet.best_slot);
  static_assert(kNoPrimitive == 0xffffffff && kNoSlot == 0xffffffff);

  const F longest = all<N>(kLongestDirection), shortest = all<N>(kShortestDirection);
  Lanes suited = kAllLanes<N>;
  const F infinity = all<N>(__builtin_inff());
  F least_t_begin = infinity;
  float tile_least[3], tile_greatest[3];
  for (int first = 0; first < kPacketRays; first += kGroupRays) {
    float least_d[3], greatest_d[3];
    F least[3] = {infinity, infinity, infinity}, greatest[3] = {-infinity, -infinity, -infinity};
    for (int i = first; i < first + kGroupRays; i += N) {
      F size{};
      for (int axis = 0; axis < 3; ++axis) {
        const F d = load<N>(packet.d[axis] + i), length = magnitude(d);
        F near, far;
        slab_factors<N>(d, near, far);
        store<N>(packet.boxes.near[axis] + i, near);
        store<N>(packet.boxes.far[axis] + i, far);
        size = greater(length, size);
        suited &= less_equal<N>(length, longest);
        least[axis] = lesser(d, least[axis]);
        greatest[axis] = greater(d, greatest[axis]);
      }
      const F t_min = load<N>(packet.t_min + i);
      const F t_begin = t_min < all<N>(kLeastBegin) ? F{} : t_min;
      store<N>(packet.t_begin + i, t_begin);
      least_t_begin = lesser(t_begin, least_t_begin);
      suited &= less_equal<N>(shortest, size) & less_equal<N>(F{}, t_min) &
                less_equal<N>(t_min, all<N>(kFarthestCoordinate)) &
                less_equal<N>(t_min, load<N>(packet.best_hi + i));
    }
    for (int axis = 0; axis < 3; ++axis) {
      least_d[axis] = least_of<N>(least[axis]);
      greatest_d[axis] = greatest_of<N>(greatest[axis]);
      tile_least[axis] = first == 0 ? least_d[axis] : lesser(least_d[axis], tile_least[axis]);
      tile_greatest[axis] =
          first == 0 ? greatest_d[axis] : greater(greatest_d[axis], tile_greatest[axis]);
    }
    packet.group_beam[first / kGroupRays] = beam_between(least_d, greatest_d);
  }
  if (suited != kAllLanes<N>) return false;
  for (int i = count; i < kPacketRays; ++i)
    packet.best_lo[i] = packet.best_hi[i] = -__builtin_inff();
  packet.beam = beam_between(tile_least, tile_greatest);
  packet.d_sum = 0;
  for (int axis = 0; axis < 3; ++axis)
    packet.d_sum += greater(-tile_least[axis], tile_greatest[axis]);
  packet.d_sum *= 1 + 0x1p-21F;
  packet.least_t_begin = least_of<N>(least_t_begin);
  bound_factors(tile_least, tile_greatest, packet.boxes.bounds);
  return true;
}

}  // namespace
}  // namespace microtrace
