#include "base/system/float_environment.hpp"
#include "scene/kernels/dispatch.hpp"
#include "scene/kernels/perspective.hpp"
#include "scene/lens/lens.hpp"

#include <microtrace/camera.hpp>

#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace microtrace {

RayDifferential RayGenerator::differential(const Ray& ray) const {
  const FloatEnvironment environment;
  const DVec3 d(ray.d);
  switch (kind_) {
    case Kind::perspective:
      return {.d_dx = direction_step<1>(forward_, right_, d),
              .d_dy = direction_step<1>(forward_, down_, d)};
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

void RayGenerator::row_spacings(const float* const (&d)[3], std::span<RowSpacing> spacings) const {
  const FloatEnvironment environment;
  constexpr std::size_t kMost = 16;
  std::array<double, kMost> spreads;
  if (kind_ == Kind::perspective && spacings.size() == kMost) {
    static const SceneKernels& kernels = kSceneKernels.best();
    kernels.row_spreads(forward_, down_, d, spreads.data(), kMost);
    for (std::size_t i = 0; i < kMost; ++i) spacings[i] = {.spread = spreads[i]};
    return;
  }
  for (std::size_t i = 0; i < spacings.size(); ++i) {
    const Vec3 direction(d[0][i], d[1][i], d[2][i]);
    const RayDifferential step = differential({.d = direction});
    const DVec3 wide(direction);
    spacings[i] = {.begin = std::sqrt(glm::dot(step.o_dy, step.o_dy)),
                   .spread = std::sqrt(glm::dot(step.d_dy, step.d_dy) / glm::dot(wide, wide))};
  }
}

}  // namespace microtrace
