#include "float_environment.hpp"
#include "scene/math/trigonometry.hpp"
#include "scene/support.hpp"

#include <microtrace/framing.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

constexpr double kFilled = 0.96;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

Framing::Framing(const View& view, ImageSize size) : low_(kInfinity), high_(-kInfinity) {
  const FloatEnvironment environment;
  const double sin_a = sin_degrees(view.azimuth), cos_a = cos_degrees(view.azimuth);
  const double sin_e = sin_degrees(view.elevation), cos_e = cos_degrees(view.elevation);
  right_ = {cos_a, 0, -sin_a};
  up_ = {-sin_e * sin_a, cos_e, -sin_e * cos_a};
  back_ = {cos_e * sin_a, sin_e, cos_e * cos_a};
  vertical_fov_ = radians_from_degrees(view.vertical_fov);
  slope_y_ = kFilled * sin_degrees(view.vertical_fov / 2) / cos_degrees(view.vertical_fov / 2);
  slope_x_ = slope_y_ * size.width / size.height;
  directions_ = {right_ + slope_x_ * back_, slope_x_ * back_ - right_, up_ + slope_y_ * back_,
                 slope_y_ * back_ - up_, back_};
  reach_.fill(-kInfinity);
}

void Framing::add(const DVec3& point) {
  for (std::size_t k = 0; k < reach_.size(); ++k) {
    reach_[k] = std::max(reach_[k], glm::dot(directions_[k], point));
  }
  low_ = glm::min(low_, point);
  high_ = glm::max(high_, point);
}

template <class Support>
void Framing::add_support(const Support& support, const DVec3& shift) {
  for (std::size_t k = 0; k < reach_.size(); ++k) {
    reach_[k] = std::max(reach_[k], support(directions_[k]) + glm::dot(directions_[k], shift));
  }
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    DVec3 unit(0);
    unit[axis] = 1;
    high_[axis] = std::max(high_[axis], support(unit) + shift[axis]);
    low_[axis] = std::min(low_[axis], -support(-unit) + shift[axis]);
  }
}

void Framing::add(const Scene& scene) {
  const FloatEnvironment environment;
  if (!origin_) origin_ = scene.origin;
  const DVec3 shift = scene.origin - *origin_;
  for (const Object& object : scene.objects) {
    visit_extent(
        object.shape, [&](const DVec3& point) { add(point + shift); },
        [&](const auto& support) { add_support(support, shift); });
  }
}

// Let s be the slope of the frustum's right and left sides. A camera at x right + y up + z back
// sees a point p inside the right side if (right + s back) . p <= x + s z, and inside the left side
// if (s back - right) . p <= s z - x. The least z for which all points satisfy both makes both
// equalities for the extreme points. The same applies to the top and bottom sides.
PerspectiveCamera Framing::camera() const {
  const FloatEnvironment environment;
  const bool point = is_empty() || low_ == high_;
  DVec3 position = is_empty() ? back_ : low_ + back_;
  if (!point) {
    const double diagonal = std::sqrt(glm::dot(high_ - low_, high_ - low_));
    const double x = (reach_[0] - reach_[1]) / 2, y = (reach_[2] - reach_[3]) / 2;
    const double z =
        std::max({(reach_[0] + reach_[1]) / (2 * slope_x_),
                  (reach_[2] + reach_[3]) / (2 * slope_y_), reach_[4] + diagonal / 64});
    position = right_ * x + up_ * y + back_ * z;
  }
  return camera_at(position);
}

PerspectiveCamera Framing::camera_around(const DVec3& target, double distance) const {
  const FloatEnvironment environment;
  return camera_at(target + distance * back_);
}

PerspectiveCamera Framing::camera_at(const DVec3& position) const {
  return {.pose = {.position = position, .direction = -back_, .up = up_},
          .vertical_fov = vertical_fov_};
}

DVec3 Framing::center() const {
  const FloatEnvironment environment;
  return is_empty() ? DVec3(0) : low_ / 2.0 + high_ / 2.0;
}

PerspectiveCamera frame(const Scene& scene, const View& view, ImageSize size) {
  Framing framing(view, size);
  framing.add(scene);
  return framing.camera();
}

Camera default_camera(const Scene& scene, ImageSize size) {
  if (!scene.cameras.empty()) return scene.cameras[0].camera;
  return frame(scene, View{}, size);
}

}  // namespace microtrace
