#pragma once
/// The directions of all rays in a frustum, as float64 intervals.

#include "scene/math/magnitudes.hpp"

#include <microtrace/frustum.hpp>
#include <microtrace/math.hpp>

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {

struct Interval {
  double lo, hi;
};

/// Directions are taken before they are scaled to unit length, so that they are linear in the
/// position on the film. A ray's direction is rounded to float32, so it is parallel to such a
/// direction with an error of at most 2^-23 of each component's magnitude, plus Frustum::error.
class Directions {
 public:
  explicit Directions(const Frustum& frustum)
      : middle_(frustum.middle),
        right_(frustum.half_right),
        down_(frustum.half_down),
        size_(glm::abs(middle_) + glm::abs(right_) + glm::abs(down_) + frustum.error / kSlack) {
    const double middle = glm::length(middle_),
                 radius = sum_of_magnitudes(right_) + sum_of_magnitudes(down_);
    lengths_ = {.lo = (middle - radius) * (1 - kSlack), .hi = (middle + radius) * (1 + kSlack)};
  }

  /// Returns bounds of n.d. The components of n must have errors of at most 2^-50 times those of
  /// `size`, which must not be less than |n|.
  [[nodiscard]] Interval along(const DVec3& n, const DVec3& size) const {
    return around(glm::dot(n, middle_), std::abs(glm::dot(n, right_)) +
                                            std::abs(glm::dot(n, down_)) +
                                            kSlack * glm::dot(size, size_));
  }
  /// Returns bounds of d_axis.
  [[nodiscard]] Interval component(int axis) const {
    return around(middle_[axis],
                  std::abs(right_[axis]) + std::abs(down_[axis]) + kSlack * size_[axis]);
  }
  /// Returns bounds of |d x m|. The components of m must have errors of at most 2^-50 |m|. If the
  /// lower bound exceeds `enough`, the bounds may be wider than necessary.
  [[nodiscard]] Interval cross_length(const DVec3& m, double enough) const {
    const DVec3 right = glm::cross(right_, m), down = glm::cross(down_, m);
    const double middle = glm::length(glm::cross(middle_, m)),
                 error = kSlack * sum_of_magnitudes(size_) * sum_of_magnitudes(m);
    const Interval wide =
        around(middle, sum_of_magnitudes(right) + sum_of_magnitudes(down) + error);
    if (wide.lo > enough) return wide;
    const Interval bounds = around(middle, glm::length(right) + glm::length(down) + error);
    return {.lo = std::max(bounds.lo, 0.0), .hi = bounds.hi};
  }
  /// Bounds of |d|. The lower one may be negative.
  [[nodiscard]] const Interval& lengths() const { return lengths_; }

 private:
  /// Twice the error of a ray's direction, which leaves room for the roundings of float64.
  static constexpr double kSlack = 0x1p-22;

  static Interval around(double middle, double radius) {
    return {.lo = middle - radius, .hi = middle + radius};
  }

  DVec3 middle_, right_, down_;
  DVec3 size_;  ///< upper bounds of the components' magnitudes
  Interval lengths_{};
};

}  // namespace microtrace
