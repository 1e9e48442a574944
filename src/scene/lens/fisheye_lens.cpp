#include "scene/lens/fisheye_lens.hpp"

#include "scene/math/roots.hpp"
#include "scene/math/trigonometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

double length_of(const DVec2& v) {
  return std::sqrt(glm::dot(v, v));
}

}  // namespace

FisheyeLens::FisheyeLens(const FisheyeDistortion& k) : k_(k) {
  // The distortion is invertible up to max_angle_, because its derivative, a polynomial in the
  // angle's square, is positive there.
  const double square = least_positive_root({1, 3 * k.k1, 5 * k.k2, 7 * k.k3, 9 * k.k4});
  max_angle_ = std::min(std::sqrt(square), std::numbers::pi);
  max_distorted_ = distorted(max_angle_);
}

double FisheyeLens::distorted(double angle) const {
  const double s = angle * angle;
  return angle * (1 + s * (k_.k1 + s * (k_.k2 + s * (k_.k3 + s * k_.k4))));
}

double FisheyeLens::slope(double angle) const {
  const double s = angle * angle;
  return 1 + s * (3 * k_.k1 + s * (5 * k_.k2 + s * (7 * k_.k3 + s * (9 * k_.k4))));
}

std::optional<DVec3> FisheyeLens::direction(const DVec2& image) const {
  const double length = length_of(image);
  if (!(length > 0)) return DVec3(0, 0, 1);
  if (!(length <= max_distorted_)) return std::nullopt;
  const auto f = [this](double angle) {
    return ValueAndSlope{.value = distorted(angle), .slope = slope(angle)};
  };
  const double angle = solve_increasing(f, length, 0, max_angle_);
  return DVec3(image * (sin_radians(angle) / length), cos_radians(angle));
}

std::optional<DVec2> FisheyeLens::image(const DVec3& direction) const {
  const DVec2 across(direction);
  const double length = length_of(across);
  if (length == 0 && direction.z > 0) return DVec2(0);
  const double angle = atan2_radians(length, direction.z);
  if (!(length > 0 && angle <= max_angle_)) return std::nullopt;
  return across * (distorted(angle) / length);
}

LensDifferential FisheyeLens::differential(const DVec3& d) const {
  constexpr double kLeastSlope = 1e-6;
  const double sine = length_of(DVec2(d)), angle = atan2_radians(sine, d.z);
  const DVec2 outward = sine > 0 ? DVec2(d) / sine : DVec2(1, 0);
  const double radius = distorted(angle);
  const DVec3 radial = DVec3(outward * d.z, -sine) / std::max(slope(angle), kLeastSlope);
  const DVec3 around = DVec3(-outward.y, outward.x, 0) * (radius > 0 ? sine / radius : 1);
  return {.dx = outward.x * radial - outward.y * around,
          .dy = outward.y * radial + outward.x * around};
}

}  // namespace microtrace
