#pragma once
#include "accel/filters/filter.hpp"

#include <microtrace/shape.hpp>

namespace microtrace {

/// A plane relative to the ray origin o: t = n.(point - o) / n.d.
class PlaneFilter {
 public:
  PlaneFilter(const Vec3& point, const Vec3& normal, const Vec3& o)
      : normal_(normal), height_(dot_product(normal, DVec3(point) - DVec3(o), 4)) {}
  PlaneFilter(const Plane& plane, const Vec3& o) : PlaneFilter(plane.point, plane.normal, o) {}

  [[nodiscard]] FilterResult operator()(const DVec3& d, const Range& range) const {
    // Two roundings would suffice, because products of two float32 numbers are exact. Counting four
    // costs nothing.
    return quotient_result(height_, dot_product(normal_, d, 4), range);
  }

 private:
  DVec3 normal_;
  Approximate height_;
};

/// A disc relative to the ray origin o. Intersects the disc's plane, then compares the squared
/// distance from the center with the squared radius.
class DiscFilter {
 public:
  DiscFilter(const Disc& disc, const Vec3& o)
      : plane_(disc.center, disc.normal, o),
        from_center_(DVec3(o) - DVec3(disc.center)),
        radius2_(double{disc.radius} * disc.radius) {}

  [[nodiscard]] FilterResult operator()(const DVec3& d, const Range& range) const {
    FilterResult crossing = plane_(d, range);
    if (crossing.certainty == Certainty::miss) return crossing;
    // If the ray is nearly parallel to the plane, there are no bounds of t and thus none of the
    // distance.
    if (!std::isfinite(crossing.lo)) return crossing;
    // Half of radius_of_t would suffice; the full interval only leaves a few more rays near the
    // edge undecided.
    const double t = (crossing.lo + crossing.hi) / 2, radius_of_t = crossing.hi - crossing.lo;
    double distance2 = 0, error = 0;
    for (int k = 0; k < 3; ++k) {
      // In q = (o - c) + t d, the first term has two roundings. The second has three, including the
      // rounding of t, and also the error of t.
      const double q = from_center_[k] + t * d[k];
      const double q_error = gamma(kRoundings) * (std::abs(from_center_[k]) + std::abs(t * d[k])) +
                             radius_of_t * std::abs(d[k]) + kUnderflow;
      distance2 += q * q;
      error += (2 * std::abs(q) + q_error) * q_error;
    }
    // The squares and their sum have three roundings. At most ten roundings of q_error and `error`
    // are of second order, so 1 + gamma(10) would suffice.
    error = error * (1 + gamma(20)) + gamma(kRoundings) * distance2 + kUnderflow;
    const double outside = distance2 - radius2_;
    if (outside > error) return {.certainty = Certainty::miss};
    if (!(outside < -error)) crossing.certainty = Certainty::unsure;
    return crossing;
  }

 private:
  static constexpr int kRoundings = 3;

  PlaneFilter plane_;
  DVec3 from_center_;
  double radius2_;  // exact, as a product of two float32 numbers
};

}  // namespace microtrace
