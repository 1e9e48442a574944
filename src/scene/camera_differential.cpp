#include "float_environment.hpp"
#include "scene/lens/lens.hpp"

#include <microtrace/camera.hpp>

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace microtrace {

RayDifferential RayGenerator::differential(const Ray& ray) const {
  const FloatEnvironment environment;
  const DVec3 d(ray.d);
  switch (kind_) {
    case Kind::perspective: {
      // Differentiates d = toward / |toward|, where `toward` has depth 1.
      const double depth = glm::dot(forward_, d);
      return {.d_dx = depth * (right_ - d * glm::dot(d, right_)),
              .d_dy = depth * (down_ - d * glm::dot(d, down_))};
    }
    case Kind::orthographic:
      return {.o_dx = right_, .o_dy = down_};
    case Kind::environment: {
      const DVec3 east = glm::cross(down_, d);  // tangent to the circle of latitude
      const double width = std::sqrt(glm::dot(east, east));
      const DVec3 south = width > 0 ? glm::cross(d, east) / width : right_;
      return {.d_dx = east * (2 * std::numbers::pi / size_.width),
              .d_dy = south * (std::numbers::pi / size_.height)};
    }
    case Kind::distorted: {
      const auto [dx, dy] =
          lens_->differential({glm::dot(d, right_), glm::dot(d, down_), glm::dot(d, forward_)});
      const auto in_world = [this](const DVec3& v) {
        return right_ * v.x + down_ * v.y + forward_ * v.z;
      };
      return {.d_dx = in_world(dx) / pixels_per_unit_.x, .d_dy = in_world(dy) / pixels_per_unit_.y};
    }
  }
  return {};
}

}  // namespace microtrace
