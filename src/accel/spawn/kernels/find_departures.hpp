#pragma once
#include "accel/spawn/kernels/double_lanes.hpp"

namespace microtrace {
namespace {

/// spacing() of floats, which are given as float64.
template <int N>
inline Double<N> spacings(const Double<N>& x) {
  // A float's exponent is its double's: 2^-149 is the least.
  using Bits = DoubleMask<N>;
  const Bits exponent = (Bits)x >> 52 & 0x7ff, least = Bits{} + (1 + 1023 - 127);
  return (Double<N>)(((exponent < least ? least : exponent) - 23) << 52);
}

/// As TrianglePlaneFilter and rounded_point() have it: N hits from the i-th on.
template <int N>
inline void find_departures_of(DepartureLanes& lanes, int i) {
  using D = Double<N>;
  const auto a = widened3<N>(lanes.a, i), b = widened3<N>(lanes.b, i), c = widened3<N>(lanes.c, i);
  const auto o = widened3<N>(lanes.o, i), d = widened3<N>(lanes.d, i);
  auto is_sure =
      filterable<N>(a) & filterable<N>(b) & filterable<N>(c) & filterable<N>(o) & filterable<N>(d);
  const auto normal = CrossProducts<N>::of(b - a, c - a);
  const auto height = normal.along(a - o, 9), slope = normal.along(d, 8);
  // quotient_verdict()
  const D size = magnitude(slope.value), t = height.value / slope.value;
  const D t_error = (height.error + magnitude(t) * slope.error) / (size - slope.error) *
                        (1 + 16 * kRoundingUnit) +
                    magnitude(t) * (8 * kRoundingUnit) + kAllUnderflow;
  const D lo = t - t_error, hi = t + t_error;
  is_sure &= (size > 4 * slope.error) & (lo >= widened<N>(lanes.t_min + i)) &
             (hi <= widened<N>(lanes.t_max + i));
  // rounded_point()
  const D middle = (lo + hi) / 2;
  D reach{}, largest{}, error{}, axis{};
  Doubles3<N> p;
  for (int k = 0; k < 3; ++k) {
    const D along = middle * d.v[k], x = o.v[k] + along;
    const D x_error = (hi - lo) * magnitude(d.v[k]) +
                      8 * kRoundingUnit * (magnitude(o.v[k]) + magnitude(along)) + kAllUnderflow;
    const auto below = __builtin_convertvector(x - x_error, Float<N>);
    const auto above = __builtin_convertvector(x + x_error, Float<N>);
    const D rounded = __builtin_convertvector(below, D);
    const auto is_shared = (a.v[k] == b.v[k]) & (a.v[k] == c.v[k]);
    is_sure &= is_shared | (rounded == __builtin_convertvector(above, D));
    p.v[k] = is_shared ? a.v[k] : rounded;
    const D unit = spacings<N>(p.v[k]), gain = magnitude(normal.value.v[k]) * unit;
    const D further = (kQuickSteps + 1) * unit;
    reach = greater(further, reach);
    error = error + 5 * kRoundingUnit * normal.permanent.v[k] * unit;
    axis = gain > largest ? D{} + k : axis;
    largest = greater(gain, largest);
  }
  // Else the choice of the axis is exact arithmetic's (TriangleSurface::gradient).
  is_sure &= error <= 0x1p-9 * largest;
  for (int k = 0; k < 3; ++k) narrowed<N>(p.v[k], lanes.p[k] + i);
  store3<N>(normal.value, lanes.n, i);
  store3<N>(normal.permanent, lanes.permanent, i);
  __builtin_memcpy(lanes.reach + i, &reach, sizeof reach);
  narrowed<N>(axis, lanes.axis + i);
  narrowed<N>(is_sure ? D{} + 1 : D{}, lanes.is_sure + i);
}

template <int N>
void find_departures(DepartureLanes& lanes) {
  for (int i = 0; i < kSpawnLanes; i += N) find_departures_of<N>(lanes, i);
}

}  // namespace
}  // namespace microtrace
