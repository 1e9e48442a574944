#pragma once
/// Fills a packet with rays: transposes the rays to one array per component and computes the beam
/// around them.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/packet/packet_boxes.hpp"
#include "accel/kernels/simd.hpp"
#include "accel/kernels/slabs.hpp"
#include "simd/masks.hpp"
#include "simd/transpose.hpp"

#include <cstddef>

namespace microtrace {
namespace {

/// Returns the numbers among the first four of each ray, o and t_min, whose bits aren't the same
/// for all of at least two rays.
template <int N>
inline Lanes differing_numbers(const float* rays, int count) {
  constexpr int kNumbers = 8, kRaysAtOnce = N < kNumbers ? 1 : N / kNumbers;
  float first[N];
  for (int i = 0; i < N; ++i) first[i] = rays[i % kNumbers];
  const auto expected = reinterpreted<Int<N>>(load<N>(first));
  Int<N> difference{};
  for (int i = 0; i < count; i += kRaysAtOnce) {
    const int ray = lesser(i, count - kRaysAtOnce);
    difference |=
        reinterpreted<Int<N>>(load<N>(rays + kNumbers * static_cast<std::ptrdiff_t>(ray))) ^
        expected;
  }
  const Lanes lanes = true_lanes<N>(difference != 0);
  return (lanes | lanes >> kNumbers) & 0xFU;
}

/// Transposes rays to one array per component. Returns false if the rays have different origins.
template <int N>
inline bool read_rays(const float* rays, KernelPacket& packet) {
  const Lanes differing = differing_numbers<N>(rays, packet.count);
  if ((differing & 7U) != 0) return false;
  for (int i = 0; i < kPacketRays; i += N) {
    std::uint32_t row[N];  // of d and t_max; a ray has two rows of four numbers
    for (int lane = 0; lane < N; ++lane)
      row[lane] = 2U * static_cast<std::uint32_t>(packet.order[i + lane]) + 1;
    if (i + N > packet.count) {
      const std::uint32_t last = 2U * static_cast<std::uint32_t>(packet.count - 1) + 1;
      for (std::uint32_t& each : row) each = lesser(each, last);
    }
    Float<N> column[4];
    load_rows<N>(rays, row, column);
    for (int axis = 0; axis < 3; ++axis) store<N>(packet.d[axis] + i, column[axis]);
    store<N>(packet.best_lo + i, column[3]);
    store<N>(packet.best_hi + i, column[3]);
    store<N>(packet.t_min + i, all<N>(rays[3]));
    if ((differing & 8U) == 0) continue;
    for (int lane = 0; lane < N; ++lane) packet.t_min[i + lane] = rays[4 * row[lane] - 1];
  }
  return true;
}

/// Returns the least lane of each of four vectors.
template <int N>
inline Float<4> least_of_each(Float<N> (&v)[4]) {
  transpose<N>(v);
  const Float<N> least = lesser(lesser(v[0], v[1]), lesser(v[2], v[3]));
  float lanes[N];
  store<N>(lanes, least);
  Float<4> result = load<4>(lanes);
  for (int i = 4; i < N; i += 4) result = lesser(load<4>(lanes + i), result);
  return result;
}

/// Sets the centers and the radii of four intervals of directions.
inline void set_intervals(const Float<4>& least, const Float<4>& greatest, float* center,
                          float* radius) {
  const Float<4> middle = 0.5F * least + 0.5F * greatest;
  store<4>(center, middle);
  store<4>(radius, greater(greatest - middle, middle - least) * (1 + 0x1p-22F) + 0x1p-126F);
}

/// Sets the beams and the bounds of factors, given lanes with the least d and -d of each group.
template <int N>
inline void set_beams(Float<N> (&least)[3][kGroups], Float<N> (&least_opposite)[3][kGroups],
                      KernelPacket& packet) {
  static_assert(kGroups == 4);
  float all_least[4] = {}, all_greatest[4] = {};
  packet.d_sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Float<4> least_d = least_of_each<N>(least[axis]),
                   greatest_d = -least_of_each<N>(least_opposite[axis]);
    set_intervals(least_d, greatest_d, packet.group_beams.center[axis],
                  packet.group_beams.radius[axis]);
    all_least[axis] = least_of<4>(least_d);
    all_greatest[axis] = greatest_of<4>(greatest_d);
    packet.d_sum += greater(-all_least[axis], all_greatest[axis]);
  }
  packet.d_sum *= 1 + 0x1p-21F;
  float center[4], radius[4];
  set_intervals(load<4>(all_least), load<4>(all_greatest), center, radius);
  for (int axis = 0; axis < 3; ++axis) {
    packet.beam.center[axis] = center[axis];
    packet.beam.radius[axis] = radius[axis];
  }
  bound_factors(load<4>(all_least), load<4>(all_greatest), packet.boxes.bounds);
}

template <int N>
bool fill_packet(const float* rays, int count, KernelPacket& packet) {
  using F = Float<N>;
  packet.count = count;
  for (int axis = 0; axis < 3; ++axis) {
    packet.o[axis] = packet.boxes.o_of_lo[axis] = packet.boxes.o_of_hi[axis] = rays[axis];
    if (!(__builtin_fabsf(rays[axis]) <= kFarthestCoordinate)) return false;
  }
  if (!read_rays<N>(rays, packet)) return false;
  // The caller's next packet of rays is usually stored directly after this one.
  constexpr int kFloats = 8 * kPacketRays;
  for (int i = kFloats; i < 2 * kFloats; i += 16) __builtin_prefetch(rays + i);
  __builtin_memset(packet.best_id, 0xff, sizeof packet.best_id);
  __builtin_memset(packet.best_index, 0xff, sizeof packet.best_index);
  static_assert(kNoPrimitive == 0xffffffff && PacketHits::kNone == 0xffffffff);
  packet.hits.count = 0;

  const F longest = all<N>(kLongestDirection), shortest = all<N>(kShortestDirection);
  Lanes suited = kAllLanes<N>;
  const F infinity = all<N>(__builtin_inff());
  F least_t_begin = infinity;
  F least[3][kGroups], least_opposite[3][kGroups];  // lanes of each group's d and -d
  for (int group = 0; group < kGroups; ++group) {
    for (int axis = 0; axis < 3; ++axis)
      least[axis][group] = least_opposite[axis][group] = infinity;
    const int first = group * kGroupRays;
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
        least[axis][group] = lesser(d, least[axis][group]);
        least_opposite[axis][group] = lesser(-d, least_opposite[axis][group]);
      }
      const F t_min = load<N>(packet.t_min + i);
      const F t_begin = t_min < all<N>(kLeastBegin) ? F{} : t_min;
      store<N>(packet.t_begin + i, t_begin);
      least_t_begin = lesser(t_begin, least_t_begin);
      suited &= less_equal<N>(shortest, size) & less_equal<N>(F{}, t_min) &
                less_equal<N>(t_min, all<N>(kFarthestCoordinate)) &
                less_equal<N>(t_min, load<N>(packet.best_hi + i));
    }
  }
  if (suited != kAllLanes<N>) return false;
  for (int i = count; i < kPacketRays; ++i)
    packet.best_lo[i] = packet.best_hi[i] = -__builtin_inff();
  set_beams<N>(least, least_opposite, packet);
  packet.least_t_begin = least_of<N>(least_t_begin);
  return true;
}

}  // namespace
}  // namespace microtrace
