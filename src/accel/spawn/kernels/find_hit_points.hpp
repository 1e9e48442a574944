#pragma once
#include "accel/spawn/kernels/double_lanes.hpp"
#include "accel/spawn/kernels/find_origins.hpp"

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

/// Rounds to float32 numbers.
template <int N>
inline Double<N> to_floats(const Double<N>& x) {
  return to_double<N>(to_single<N>(x));
}

/// Computes coordinate_in_plane() of the points x in planes through a.
template <int N>
struct CoordinateInPlane {
  Double<N> value, error;

  CoordinateInPlane(const CrossProducts<N>& normal, const Doubles3<N>& x,
                    const Doubles3<N>& x_error, const Doubles3<N>& a, int k) {
    using D = Double<N>;
    D w{}, terms_error{};
    for (int other = 1; other <= 2; ++other) {
      const int i = (k + other) % 3;
      const D r = x.v[i] - a.v[i], n = normal.value.v[i];
      w = w + n * r;
      const D error_of_term = magnitude(n) * x_error.v[i] + kTermRoundings * kRounding *
                                                                normal.permanent.v[i] *
                                                                (magnitude(r) + x_error.v[i]);
      terms_error = terms_error + error_of_term;
    }
    const D& permanent = normal.permanent.v[k];
    const D n_size = magnitude(normal.value.v[k]) - 6 * kRounding * permanent;
    w = w / normal.value.v[k];
    value = a.v[k] - w;
    const D w_error =
        (terms_error + 8 * kRounding * permanent * magnitude(w)) / n_size * (1 + 16 * kRounding);
    error = n_size > 0 ? w_error + 4 * kRounding * magnitude(value) + kUnderflow
                       : D{} + __builtin_inf();
  }
};

/// Returns the lanes in which the normal is along the axis k.
template <int N>
inline DoubleMask<N> is_along(const CrossProducts<N>& normal, int k) {
  return (normal.permanent.v[(k + 1) % 3] == 0) & (normal.permanent.v[(k + 2) % 3] == 0);
}

/// Returns the lanes whose vertices and rays are within the filters' limit. Compares bits, which
/// have the order of the numbers; those of NaN are the greatest.
template <int N>
inline DoubleMask<N> filterable_lanes(const HitPointLanes& lanes, int i) {
  Int<N> greatest{};
  const SpawnFloats* const all_vectors[] = {lanes.a, lanes.b, lanes.c, lanes.o, lanes.d};
  for (const SpawnFloats* const vectors : all_vectors) {
    for (int k = 0; k < 3; ++k) {
      const auto bits = reinterpreted<Int<N>>(magnitude(load<N>(vectors[k] + i)));
      greatest = bits > greatest ? bits : greatest;
    }
  }
  const auto most = reinterpreted<Int<N>>(all<N>(kGreatestCoordinate));
  return __builtin_convertvector(greatest <= most, DoubleMask<N>);
}

/// Computes the hit points of N lanes starting at lane i, as TrianglePlaneFilter and
/// rounded_point() do.
template <int N>
inline void find_hit_points_of(HitPointLanes& lanes, int i) {
  using D = Double<N>;
  const auto a = widened3<N>(lanes.a, i), b = widened3<N>(lanes.b, i), c = widened3<N>(lanes.c, i);
  const auto o = widened3<N>(lanes.o, i), d = widened3<N>(lanes.d, i);
  DoubleMask<N> is_sure = filterable_lanes<N>(lanes, i);
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
  // as PointOnRay
  const D middle = (lo + hi) / 2;
  Doubles3<N> x, x_error;
  for (int k = 0; k < 3; ++k) {
    const D along = middle * d.v[k];
    x.v[k] = o.v[k] + along;
    x_error.v[k] = (hi - lo) * magnitude(d.v[k]) +
                   8 * kRounding * (magnitude(o.v[k]) + magnitude(along)) + kUnderflow;
  }
  // as rounded_point() and best_step()
  D largest{}, error{}, axis{};
  Doubles3<N> p, units;
  for (int k = 0; k < 3; ++k) {
    D below = x.v[k] - x_error.v[k], above = x.v[k] + x_error.v[k];
    D least = to_floats<N>(below), greatest = to_floats<N>(above);
    // On an axis-aligned plane, the formula below would give the plane's coordinate.
    const DoubleMask<N> is_in_plane = is_along<N>(normal, k);
    least = is_in_plane ? a.v[k] : least;
    greatest = is_in_plane ? a.v[k] : greatest;
    if (true_double_lanes<N>(least != greatest) != 0) {
      const CoordinateInPlane<N> in_plane(normal, x, x_error, a, k);
      // These bounds may be NaN; `greater` and `lesser` then return the other bound.
      below = greater(in_plane.value - in_plane.error, below);
      above = lesser(in_plane.value + in_plane.error, above);
      least = to_floats<N>(below);
      greatest = to_floats<N>(above);
    }
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
  D plane_axis = D{} - 1, plane_at{};
  for (int k = 2; k >= 0; --k) {
    reach.v[k] = axis == k ? reach_of(kFlatSteps, 1) * units.v[k] : units.v[k] / 2;
    // The margin is twice the reach, because the ends are rounded by less than the reach.
    const D infinite = D{} + __builtin_inf(), margin = 2 * reach.v[k];
    narrowed<N>(is_sure ? p.v[k] - margin : infinite, lanes.lo[k] + i);
    narrowed<N>(is_sure ? p.v[k] + margin : -infinite, lanes.hi[k] + i);
    const DoubleMask<N> is_normal = is_along<N>(normal, k);
    plane_axis = is_normal ? D{} + k : plane_axis;
    plane_at = is_normal ? a.v[k] : plane_at;
  }
  store3<N>(reach, lanes.reach, i);
  narrowed<N>(plane_axis, lanes.plane_axis + i);
  narrowed<N>(plane_at, lanes.plane_at + i);
  narrowed<N>(axis, lanes.axis + i);
  narrowed<N>(is_sure ? D{} + 1 : D{}, lanes.is_sure + i);
  const DoubleMask<N> to_front = slope.value < 0;
  const DoubleMask<N> has_origin = move_off<N>(normal, a, axis, to_front, is_sure, p);
  for (int k = 0; k < 3; ++k) narrowed<N>(p.v[k], lanes.origin[k] + i);
  narrowed<N>(has_origin ? (to_front ? D{} + 1 : D{} - 1) : D{}, lanes.side + i);
}

template <int N>
void find_hit_points(HitPointLanes& lanes) {
  for (int i = 0; i < kSpawnLanes; i += N) find_hit_points_of<N>(lanes, i);
}

}  // namespace
}  // namespace microtrace
