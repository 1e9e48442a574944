#pragma once
#include "accel/filters/filter.hpp"

#include <microtrace/shape.hpp>

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// A plane relative to the ray origin o: t = n.(point - o) / n.d.
[[nodiscard]] inline SeenPlane plane_seen_from(const Vec3& o, const Vec3& point,
                                               const Vec3& normal) {
  const Approximate height = dot_product(DVec3(normal), DVec3(point) - DVec3(o), 4);
  return {.normal = DVec3(normal), .height = bounded(height)};
}

template <int N = 1>
[[nodiscard]] inline FilterResults<N> filter(const SeenPlane& plane, const Doubles3<N>& d,
                                             const Ranges<N>& range) {
  // Two roundings would suffice, because products of two float32 numbers are exact. Counting four
  // costs nothing.
  return quotient_result<N>(all_rays<N>(plane.height),
                            dot_product<N>(all_lanes<N>(plane.normal), d, 4), range);
}

/// A disc relative to the ray origin o. Intersects the disc's plane, then compares the squared
/// distance from the center with the squared radius.
[[nodiscard]] inline SeenDisc disc_seen_from(const Vec3& o, const Disc& disc) {
  return {.plane = plane_seen_from(o, disc.center, disc.normal),
          .from_center = DVec3(o) - DVec3(disc.center),
          .radius2 = double{disc.radius} * disc.radius};
}

template <int N = 1>
[[nodiscard]] inline FilterResults<N> filter(const SeenDisc& disc, const Doubles3<N>& d,
                                             const Ranges<N>& range) {
  constexpr int kRoundings = 3;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  FilterResults<N> crossing = filter<N>(disc.plane, d, range);
  // If the ray is nearly parallel to the plane, there are no bounds of t and thus none of the
  // distance.
  const RayMask<N> has_t = crossing.hi < kInfinity;
  // Half of radius_of_t would suffice; the full interval only leaves a few more rays near the edge
  // undecided.
  const Double<N> t = (crossing.lo + crossing.hi) / 2, radius_of_t = crossing.hi - crossing.lo;
  Double<N> distance2{}, error{};
  const auto add = [&](double from_center, const Double<N>& direction) {
    // In q = (o - c) + t d, the first term has two roundings. The second has three, including the
    // rounding of t, and also the error of t.
    const Double<N> way = t * direction, q = from_center + way;
    const Double<N> q_error = gamma(kRoundings) * (magnitude(from_center) + magnitude(way)) +
                              radius_of_t * magnitude(direction) + kUnderflow;
    distance2 += q * q;
    error += (2 * magnitude(q) + q_error) * q_error;
  };
  add(disc.from_center.x, d.x);
  add(disc.from_center.y, d.y);
  add(disc.from_center.z, d.z);
  // The squares and their sum have three roundings. At most ten roundings of q_error and `error`
  // are of second order, so 1 + gamma(10) would suffice.
  error = error * (1 + gamma(20)) + gamma(kRoundings) * distance2 + kUnderflow;
  const Double<N> outside = distance2 - disc.radius2;
  crossing.miss |= has_t & (outside > error);
  crossing.hit &= outside < -error;
  return crossing;
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
