#pragma once
#include "accel/spawn/kernels/double_lanes.hpp"

namespace microtrace {
namespace {

/// Computes neighbor() for N lanes.
template <int N>
inline Float<N> neighbors(const Float<N>& x, const typename FloatVector<N>::bits_type& up) {
  using Bits = Unsigned<N>;  // unsigned, because they may wrap around in unused lanes
  const Bits bits = (Bits)x, one = Bits{} + 1;
  const Bits away = (x > 0) == (up != 0) ? bits + one : bits - one;
  const Bits from_zero = up != 0 ? one : one | 0x80000000U;
  return (Float<N>)(x == 0 ? from_zero : away);
}

/// Moves the points q off surfaces through a, along the axes, until they are certainly on the side
/// of rays to the front or back. Starts at the points of lanes that are `open`. Returns the lanes
/// in which this succeeds.
template <int N>
inline DoubleMask<N> move_off(const CrossProducts<N>& normal, const Doubles3<N>& a,
                              const Double<N>& axis, const DoubleMask<N>& to_front,
                              DoubleMask<N> open, Doubles3<N>& q) {
  using D = Double<N>;
  using Mask = DoubleMask<N>;
  const Mask up = (component<N>(normal.value, axis) > 0) == (to_front != 0);
  const auto up_floats = __builtin_convertvector(up, typename FloatVector<N>::bits_type);
  Mask is_sure{};
  for (int step = 0; step <= kFlatSteps; ++step) {
    const auto from_a = q - a;
    // as certain_side()
    const D value = dot<N>(from_a, normal.value);
    const D permanent = dot<N>(magnitudes<N>(from_a), normal.permanent);
    const D error = kHeightRoundings * kRounding * permanent + kUnderflow;
    const Mask in_front = value > error, behind = value < -error;
    const Mask is_there = (to_front & in_front) | (~to_front & behind);
    is_sure |= open & is_there;
    // If all terms are zero, the point is exactly on the plane, which is common on floors and
    // walls.
    open &= ~is_there & (in_front | behind | (permanent == 0));
    if (true_double_lanes<N>(open) == 0) break;
    const Float<N> x = to_single<N>(component<N>(q, axis));
    const D moved = to_double<N>(neighbors<N>(x, up_floats)) + D{};  // replaces -0 by 0
    for (int k = 0; k < 3; ++k) q.v[k] = (open & (axis == k)) ? moved : q.v[k];
  }
  return is_sure;
}

/// Finds the origins of N lanes starting at lane i. Returns the certain ones among those wanted.
template <int N>
inline Lanes find_origins_of(const HitPointLanes& points, OriginLanes& lanes, Lanes wanted, int i) {
  using Mask = DoubleMask<N>;
  const CrossProducts<N> normal(load3<N>(points.n, i), load3<N>(points.permanent, i));
  const auto direction = widened3<N>(lanes.direction, i);
  const auto slope = normal.along(direction, kSlopeRoundings);
  const Mask to_front = slope.value > slope.error, to_back = slope.value < -slope.error;
  const Mask open = filterable<N>(direction) & (to_front | to_back);
  const Double<N> side = widened<N>(points.side + i);
  const Lanes found = true_double_lanes<N>(open & (to_front ? side > 0 : side < 0));
  if ((wanted & ~found) == 0) {
    for (int k = 0; k < 3; ++k)
      __builtin_memcpy(lanes.origin[k] + i, points.origin[k] + i, N * sizeof(float));
    return found;
  }
  auto q = widened3<N>(points.p, i);
  const Mask is_sure =
      move_off<N>(normal, widened3<N>(points.a, i), widened<N>(points.axis + i), to_front, open, q);
  for (int k = 0; k < 3; ++k) narrowed<N>(q.v[k], lanes.origin[k] + i);
  return true_double_lanes<N>(is_sure);
}

template <int N>
Lanes find_origins(const HitPointLanes& points, OriginLanes& lanes, Lanes wanted) {
  Lanes sure = 0;
  for (int i = 0; i < kSpawnLanes; i += N)
    sure |= find_origins_of<N>(points, lanes, wanted >> i & kAllLanes<N>, i) << i;
  return sure & wanted;
}

}  // namespace
}  // namespace microtrace
