#include "base/system/float_environment.hpp"
#include "scene/math/magnitudes.hpp"
#include "scene/math/trigonometry.hpp"
#include "scene/support.hpp"
#include "scene/translation_to_origin.hpp"

#include <microtrace/framing.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// The part of the picture that shapes may fill. The rest is air around them.
constexpr double kFilled = 0.9;
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
  const double slope_y =
      kFilled * sin_degrees(view.vertical_fov / 2) / cos_degrees(view.vertical_fov / 2);
  sides_[0].axis = right_, sides_[0].slope = slope_y * size.width / size.height;
  sides_[1].axis = up_, sides_[1].slope = slope_y;
  for (Sides& sides : sides_) {
    sides.positive.fill(-kInfinity);
    sides.negative.fill(-kInfinity);
  }
  reach_ = -kInfinity;
}

void Framing::add(const DVec3& point) {
  const double back = glm::dot(back_, point);
  reach_ = std::max(reach_, back);
  for (Sides& sides : sides_) {
    const double along = glm::dot(sides.axis, point);
    for (std::size_t k = 0; k < Sides::kSlopes; ++k) {
      const double near = sides.slope_at(k) * back;
      sides.positive[k] = std::max(sides.positive[k], near + along);
      sides.negative[k] = std::max(sides.negative[k], near - along);
    }
  }
  low_ = glm::min(low_, point);
  high_ = glm::max(high_, point);
}

bool Framing::holds(const DVec3& point) const {
  // The margin exceeds the rounding errors of all extents.
  const double margin = 0x1p-44 * sum_of_magnitudes(point);
  const double back = glm::dot(back_, point);
  bool holds = back + margin <= reach_;
  for (const Sides& sides : sides_) {
    const double along = glm::dot(sides.axis, point);
    for (std::size_t k = 0; k < Sides::kSlopes; ++k) {
      const double near = sides.slope_at(k) * back, slack = margin * (1 + sides.slope_at(k));
      holds = holds && near + along + slack <= sides.positive[k] &&
              near - along + slack <= sides.negative[k];
    }
  }
  return holds && glm::min(low_, point) == low_ && glm::max(high_, point) == high_;
}

template <class Support>
void Framing::add_support(const Support& support, const DVec3& shift) {
  const auto extend = [&](double& reach, const DVec3& direction) {
    reach = std::max(reach, support(direction) + glm::dot(direction, shift));
  };
  extend(reach_, back_);
  for (Sides& sides : sides_) {
    for (std::size_t k = 0; k < Sides::kSlopes; ++k) {
      extend(sides.positive[k], sides.slope_at(k) * back_ + sides.axis);
      extend(sides.negative[k], sides.slope_at(k) * back_ - sides.axis);
    }
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
  ChunkedMeshes chunks;
  const auto contains = [&](const MeshChunks::Box& box) {
    for (const DVec3& corner :
         corners_of(PointBounds{.low = DVec3(box.lo) + shift, .high = DVec3(box.hi) + shift}))
      if (!holds(corner)) return false;
    return true;
  };
  for (const ObjectRun& run : scene.objects.runs()) {
    for (std::size_t i = 0; i < run.count; ++i) {
      visit_extent(
          {run, i}, chunks, contains, [&](const DVec3& point) { add(point + shift); },
          [&](const auto& support) { add_support(support, shift); });
    }
  }
}

double Framing::Sides::slope_at(std::size_t k) const {
  return slope * static_cast<double>(k) / (kSlopes - 1);
}

// Let s be the slope of the frustum's right and left sides. A camera at x right + y up + z back
// sees a point p inside the right side if (right + s back) . p <= x + s z, and inside the left side
// if (s back - right) . p <= s z - x. The least z for which all points satisfy both makes both
// equalities for the extreme points. The same applies to the top and bottom sides.
double Framing::Sides::least_z() const {
  return (positive.back() + negative.back()) / (2 * slope);
}

// For a given z, the extreme points satisfy both equalities at the slope s for which the sum of
// both extents is 2 s z. The extents are convex functions of s, so those interpolated between two
// slopes are at least the actual ones, and all points remain within the greatest slope.
double Framing::Sides::centered(double z) const {
  const auto excess = [&](std::size_t k) {
    return positive[k] + negative[k] - 2 * slope_at(k) * z;
  };
  std::size_t k = kSlopes - 1;
  while (k > 1 && excess(k - 1) < 0) --k;
  const double below = excess(k - 1), above = excess(k);
  const double share = below > above ? std::clamp(below / (below - above), 0.0, 1.0) : 1;
  const auto middle = [&](std::size_t i) { return (positive[i] - negative[i]) / 2; };
  return middle(k - 1) + share * (middle(k) - middle(k - 1));
}

PerspectiveCamera Framing::camera() const {
  const FloatEnvironment environment;
  const bool point = is_empty() || low_ == high_;
  DVec3 position = is_empty() ? back_ : low_ + back_;
  if (!point) {
    const double diagonal = std::sqrt(glm::dot(high_ - low_, high_ - low_));
    const double z = std::max({sides_[0].least_z(), sides_[1].least_z(), reach_ + diagonal / 64});
    position = right_ * sides_[0].centered(z) + up_ * sides_[1].centered(z) + back_ * z;
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
