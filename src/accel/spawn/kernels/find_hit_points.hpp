#pragma once
#include "accel/spawn/kernels/double_lanes.hpp"

namespace microtrace {
namespace {

/// Computes spacing() for float32 numbers that are stored as float64.
template <int N>
inline Double<N> spacings(const Double<N>& x) {
  // A float32 number has the same exponent in float64. The least spacing is 2^-149.
  using Bits = DoubleMask<N>;
  const Bits exponent = (Bits)x >> 52 & 0x7ff, least = Bits{} + (1 + 1023 - 127);
  return (Double<N>)(((exponent < least ? least : exponent) - 23) << 52);
}

/// Computes the hit points of N lanes starting at lane i, as TrianglePlaneFilter and
/// rounded_point() do.
template <int N>
inline void find_hit_points_of(HitPointLanes& lanes, int i) {
  using D = Double<N>;
  const auto a = widened3<N>(lanes.a, i), b = widened3<N>(lanes.b, i), c = widened3<N>(lanes.c, i);
  const auto o = widened3<N>(lanes.o, i), d = widened3<N>(lanes.d, i);
  auto is_sure =
      filterable<N>(a) & filterable<N>(b) & filterable<N>(c) & filterable<N>(o) & filterable<N>(d);
  const auto normal = CrossProducts<N>::of(b - a, c - a);
  const auto height = normal.along(a - o, kHeightRoundings),
             slope = normal.along(d, kSlopeRoundings);
  // as quotient_result()
  const D size = magnitude(slope.value), t = height.value / slope.value;
  const D t_error =
      (height.error + magnitude(t) * slope.error) / (size - slope.error) * (1 + 16 * kRounding) +
      magnitude(t) * (kQuotientRoundings * kRounding) + kUnderflow;
  const D lo = t - t_error, hi = t + t_error;
  const D t_min = widened<N>(lanes.t_min + i);
  is_sure &=
      (size > 4 * slope.error) & (t_min >= 0) & (lo >= t_min) & (hi <= widened<N>(lanes.t_max + i));
  // as PointOnRay, and the terms of coordinate_in_plane()
  const D middle = (lo + hi) / 2;
  Doubles3<N> x, x_error, term, term_error;
  for (int k = 0; k < 3; ++k) {
    const D along = middle * d.v[k];
    x.v[k] = o.v[k] + along;
    x_error.v[k] = (hi - lo) * magnitude(d.v[k]) +
                   8 * kRounding * (magnitude(o.v[k]) + magnitude(along)) + kUnderflow;
    const D r = x.v[k] - a.v[k];
    term.v[k] = normal.value.v[k] * r;
    term_error.v[k] =
        magnitude(normal.value.v[k]) * x_error.v[k] +
        kTermRoundings * kRounding * normal.permanent.v[k] * (magnitude(r) + x_error.v[k]);
  }
  // as rounded_point() and best_step()
  D largest{}, error{}, axis{};
  Doubles3<N> p, units;
  for (int k = 0; k < 3; ++k) {
    const int i1 = (k + 1) % 3, i2 = (k + 2) % 3;
    const D& permanent = normal.permanent.v[k];
    const D n_size = magnitude(normal.value.v[k]) - 6 * kRounding * permanent;
    const D w = (term.v[i1] + term.v[i2]) / normal.value.v[k], in_plane = a.v[k] - w;
    const D w_error =
        (term_error.v[i1] + term_error.v[i2] + 8 * kRounding * permanent * magnitude(w)) / n_size *
        (1 + 16 * kRounding);
    const D in_plane_error = n_size > 0 ? w_error + 4 * kRounding * magnitude(in_plane) + kUnderflow
                                        : D{} + __builtin_inf();
    // A bound that is computed from the plane may be NaN; `greater` and `lesser` then return the
    // other bound.
    const D below = greater(in_plane - in_plane_error, x.v[k] - x_error.v[k]),
            above = lesser(in_plane + in_plane_error, x.v[k] + x_error.v[k]);
    const D least = __builtin_convertvector(__builtin_convertvector(below, Float<N>), D),
            greatest = __builtin_convertvector(__builtin_convertvector(above, Float<N>), D);
    is_sure &= least == greatest;
    p.v[k] = least + D{};  // replaces -0 by 0
    units.v[k] = spacings<N>(p.v[k]);
    const D gain = magnitude(normal.value.v[k]) * units.v[k];
    error = error + 5 * kRounding * normal.permanent.v[k] * units.v[k];
    axis = gain > largest ? D{} + k : axis;
    largest = greater(gain, largest);
  }
  // If the error is larger, exact arithmetic chooses the axis (TriangleSurface::gradient).
  is_sure &= error <= 0x1p-9 * largest;
  for (int k = 0; k < 3; ++k) narrowed<N>(p.v[k], lanes.p[k] + i);
  store3<N>(normal.value, lanes.n, i);
  store3<N>(normal.permanent, lanes.permanent, i);
  Doubles3<N> reach;
  D plane_axis = D{} - 1;
  for (int k = 2; k >= 0; --k) {
    reach.v[k] = axis == k ? reach_of(kFlatSteps, 1) * units.v[k] : units.v[k] / 2;
    // The margin is twice the reach, because the ends are rounded by less than the reach.
    const D infinite = D{} + __builtin_inf(), margin = 2 * reach.v[k];
    narrowed<N>(is_sure ? p.v[k] - margin : infinite, lanes.lo[k] + i);
    narrowed<N>(is_sure ? p.v[k] + margin : -infinite, lanes.hi[k] + i);
    const auto is_normal =
        (normal.permanent.v[(k + 1) % 3] == 0) & (normal.permanent.v[(k + 2) % 3] == 0);
    plane_axis = is_normal ? D{} + k : plane_axis;
  }
  store3<N>(reach, lanes.reach, i);
  narrowed<N>(plane_axis, lanes.plane_axis + i);
  narrowed<N>(axis, lanes.axis + i);
  narrowed<N>(is_sure ? D{} + 1 : D{}, lanes.is_sure + i);
}

template <int N>
void find_hit_points(HitPointLanes& lanes) {
  for (int i = 0; i < kSpawnLanes; i += N) find_hit_points_of<N>(lanes, i);
}

}  // namespace
}  // namespace microtrace
