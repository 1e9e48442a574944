#include "base/system/float_environment.hpp"
#include "scene/kernels/dispatch.hpp"
#include "scene/kernels/perspective.hpp"
#include "scene/lens/lens.hpp"
#include "scene/math/magnitudes.hpp"
#include "scene/math/trigonometry.hpp"

#include <microtrace/camera.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <type_traits>
#include <variant>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

struct Frame {
  DVec3 forward, right, up;  // orthonormal, right-handed with +y up: right = forward x up
};

Frame frame_of(const Pose& pose) {
  const DVec3 forward = glm::normalize(pose.direction);
  const DVec3 right = glm::normalize(glm::cross(forward, pose.up));
  return {.forward = forward, .right = right, .up = glm::cross(right, forward)};
}

double aspect(ImageSize size) {
  return double{1} * size.width / size.height;
}

// Half the height of the smallest picture that contains the whole window. `half` is half the
// window's height.
double fitted(double half, const std::optional<double>& window_aspect, ImageSize size) {
  return window_aspect ? half * std::max(1.0, *window_aspect / aspect(size)) : half;
}

float at_least_above_zero(double t) {
  return std::max(static_cast<float>(t), std::numeric_limits<float>::denorm_min());
}

// The coordinates of v's projection in the basis of the perpendicular vectors `right` and `down`.
DVec2 in_steps(const DVec3& v, const DVec3& right, const DVec3& down) {
  return {glm::dot(v, right) / glm::dot(right, right), glm::dot(v, down) / glm::dot(down, down)};
}

}  // namespace

Pose pose_from_opencv(const DMat4& camera_from_world) {
  const FloatEnvironment environment;
  const glm::dmat3 world_from_camera = glm::transpose(glm::dmat3(camera_from_world));
  return {.position = -(world_from_camera * DVec3(camera_from_world[3])),
          .direction = world_from_camera[2],
          .up = -world_from_camera[1]};
}

RayGenerator::RayGenerator(const Camera& camera, ImageSize size) : size_(size) {
  const FloatEnvironment environment;
  const Pose& pose = std::visit([](const auto& c) -> const Pose& { return c.pose; }, camera);
  const Frame frame = frame_of(pose);
  position_ = pose.position;
  forward_ = frame.forward;
  center_ = DVec2(size.width, size.height) * 0.5;
  pixels_per_unit_ = DVec2(0);

  // Sets the image plane. `half` is half its height: at depth 1 for perspective cameras, in world
  // units for orthographic ones.
  const auto set_plane = [&](Kind kind, double half, const DVec3& middle) {
    kind_ = kind;
    right_ = frame.right * (2 * half * aspect(size) / size.width);
    down_ = frame.up * (-2 * half / size.height);
    corner_ = middle - frame.right * (half * aspect(size)) + frame.up * half;
    pixels_per_unit_ = DVec2(1 / glm::length(right_));
  };
  const auto set = [&]<typename AnyCamera>(const AnyCamera& c) {
    if constexpr (std::is_same_v<AnyCamera, PerspectiveCamera>) {
      const double half = tan_radians(c.vertical_fov / 2);
      set_plane(Kind::perspective, fitted(half, c.aspect_ratio, size), forward_);
      has_lens_ = c.lens_radius > 0;
      focus_ = c.focus;
      lens_right_ = glm::normalize(right_) * c.lens_radius;
      lens_down_ = glm::normalize(down_) * c.lens_radius;
      depth_ = c.depth;
    } else if constexpr (std::is_same_v<AnyCamera, OrthographicCamera>) {
      set_plane(Kind::orthographic, fitted(c.height / 2, c.aspect_ratio, size), position_);
      depth_ = c.depth;
    } else if constexpr (std::is_same_v<AnyCamera, CalibratedCamera>) {
      const DVec2 scale = DVec2(size.width, size.height) / DVec2(c.image.width, c.image.height);
      center_ = DVec2(c.cx + 0.5, c.cy + 0.5) * scale;
      pixels_per_unit_ = DVec2(c.fx, c.fy) * scale;
      distortion_ = c.distortion;
      depth_ = c.depth;
      if (c.distortion == Distortion(RationalDistortion{})) {
        kind_ = Kind::perspective;
        right_ = frame.right / pixels_per_unit_.x;
        down_ = -frame.up / pixels_per_unit_.y;
        corner_ = forward_ - right_ * center_.x - down_ * center_.y;
      } else {
        kind_ = Kind::distorted;
        right_ = frame.right;
        down_ = -frame.up;
        lens_ = std::make_shared<const Lens>(c.distortion);
      }
    } else {
      static_assert(std::is_same_v<AnyCamera, EnvironmentCamera>);
      kind_ = Kind::environment;
      right_ = frame.right;
      down_ = -frame.up;
    }
  };
  std::visit(set, camera);
}

Ray RayGenerator::ray_at(double x, double y) const {
  Ray ray;
  // `toward` is the direction, scaled to depth 1, or to length 1 for cameras whose near and far are
  // distances.
  const auto set_direction = [&](const DVec3& toward) {
    const LaneRays<1> lane = rays_toward<1>(toward, depth_.near, depth_.far);
    // Member by member, because copying a struct that was just written in parts stalls store
    // forwarding.
    ray.o = Vec3(position_);
    ray.t_min = lane.t_min;
    ray.d = lane.d;
    ray.t_max = lane.t_max;
  };
  switch (kind_) {
    case Kind::perspective:
      set_direction(toward_pixel<1>(corner_, right_, down_, x, y));
      break;
    case Kind::orthographic:
      ray.o = Vec3(corner_ + right_ * x + down_ * y);
      ray.d = Vec3(forward_);
      ray.t_min = at_least_above_zero(depth_.near);
      ray.t_max = static_cast<float>(depth_.far);
      break;
    case Kind::environment: {
      const double longitude = (x / size_.width - 0.5) * 360;
      const double latitude = (0.5 - y / size_.height) * 180;
      const double level = cos_degrees(latitude);
      ray.o = Vec3(position_);
      ray.d = Vec3(forward_ * (level * cos_degrees(longitude)) +
                   right_ * (level * sin_degrees(longitude)) - down_ * sin_degrees(latitude));
      break;
    }
    case Kind::distorted:
      if (const auto d = lens_->direction((DVec2(x, y) - center_) / pixels_per_unit_)) {
        set_direction(right_ * d->x + down_ * d->y + forward_ * d->z);
      } else {
        ray = {.o = Vec3(position_), .d = Vec3(forward_), .t_max = -1};
      }
      break;
  }
  return ray;
}

Ray RayGenerator::operator()(double x, double y) const {
  const FloatEnvironment environment;
  return ray_at(x, y);
}

Ray RayGenerator::through_lens(double x, double y, const DVec2& on_lens) const {
  const FloatEnvironment environment;
  const DVec3 to_lens = lens_right_ * on_lens.x + lens_down_ * on_lens.y;
  const DVec3 toward = toward_pixel<1>(corner_, right_, down_, x, y) - to_lens / focus_;
  const LaneRays<1> lane = rays_toward<1>(toward, depth_.near, depth_.far);
  return {.o = Vec3(position_ + to_lens), .t_min = lane.t_min, .d = lane.d, .t_max = lane.t_max};
}

void RayGenerator::centers(std::uint32_t x, std::uint32_t y, std::span<Ray> rays) const {
  centers(x, y, static_cast<std::uint32_t>(rays.size()), 0, rays);
}

void RayGenerator::centers(std::uint32_t x, std::uint32_t y, std::uint32_t width, float least_t_min,
                           std::span<Ray> rays) const {
  constexpr std::size_t kChunk = 64;
  std::array<double, kChunk> xs, ys;
  std::size_t column = 0;
  double center_y = y + 0.5;
  for (std::size_t first = 0; first < rays.size(); first += kChunk) {
    const std::size_t size = std::min(kChunk, rays.size() - first);
    for (std::size_t i = 0; i < size; ++i) {
      xs[i] = x + static_cast<double>(column) + 0.5;
      ys[i] = center_y;
      if (++column < width) continue;
      column = 0;
      ++center_y;
    }
    through(std::span(xs).first(size), std::span(ys).first(size), least_t_min,
            rays.subspan(first, size));
  }
}

void RayGenerator::through(std::span<const double> x, std::span<const double> y, float least_t_min,
                           std::span<Ray> rays) const {
  const FloatEnvironment environment;
  if (kind_ == Kind::perspective) {
    static const SceneKernels& kernels = kSceneKernels.best();
    const PerspectiveRays camera{.corner = corner_,
                                 .right = right_,
                                 .down = down_,
                                 .origin = Vec3(position_),
                                 .least_t_min = least_t_min,
                                 .near = depth_.near,
                                 .far = depth_.far};
    kernels.perspective_rays(camera, x.data(), y.data(), rays.data(), rays.size());
    return;
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i] = ray_at(x[i], y[i]);
    rays[i].t_min = std::max(rays[i].t_min, least_t_min);
  }
}

std::optional<Frustum> RayGenerator::frustum(double x0, double y0, double x1, double y1) const {
  const FloatEnvironment environment;
  if (kind_ != Kind::perspective) return std::nullopt;
  constexpr double kSlack = 0x1p-20;
  Frustum result{.o = Vec3(position_),
                 .middle = toward_pixel<1>(corner_, right_, down_, (x0 + x1) / 2, (y0 + y1) / 2),
                 .half_right = right_ * ((x1 - x0) / 2),
                 .half_down = down_ * ((y1 - y0) / 2)};
  const double length = glm::length(result.middle),
               radius = sum_of_magnitudes(result.half_right) + sum_of_magnitudes(result.half_down);
  // Each sum of three terms and its terms have at most four roundings.
  result.error =
      0x1p-50 *
      (sum_of_magnitudes(corner_) + sum_of_magnitudes(right_) * std::max(-x0, x1) +
       sum_of_magnitudes(down_) * std::max(-y0, y1) + sum_of_magnitudes(result.middle) + radius);
  if (!(result.error < 0x1p-30 * (length - radius))) return std::nullopt;
  result.greatest_t_min = depth_.near * (length + radius) * (1 + kSlack);
  result.least_t_max = depth_.far * (length - radius) * (1 - kSlack);
  return result;
}

std::optional<DVec2> RayGenerator::project(const DVec3& point) const {
  const FloatEnvironment environment;
  const DVec3 v = point - position_;
  const double depth = glm::dot(v, forward_);
  switch (kind_) {
    case Kind::perspective:
      if (!(depth > 0)) return std::nullopt;
      return center_ + in_steps(v, right_, down_) / depth;
    case Kind::orthographic:
      return center_ + in_steps(v, right_, down_);
    case Kind::environment: {
      const double across = glm::dot(v, right_), up = -glm::dot(v, down_);
      const double level = std::sqrt(across * across + depth * depth);
      if (!(level > 0 || up != 0)) return std::nullopt;
      const double longitude = atan2_radians(across, depth);
      return DVec2((longitude / (2 * std::numbers::pi) + 0.5) * size_.width,
                   (0.5 - atan2_radians(up, level) / std::numbers::pi) * size_.height);
    }
    case Kind::distorted: {
      const auto image = lens_->image({glm::dot(v, right_), glm::dot(v, down_), depth});
      if (!image) return std::nullopt;
      return center_ + *image * pixels_per_unit_;
    }
  }
  return std::nullopt;
}

double RayGenerator::depth_at(const DVec3& point) const {
  const DVec3 way = point - position_;
  return kind_ == Kind::environment ? std::sqrt(glm::dot(way, way)) : glm::dot(way, forward_);
}

double RayGenerator::depth(const DVec3& point) const {
  const FloatEnvironment environment;
  return depth_at(point);
}

void RayGenerator::depths(std::span<const double> x, std::span<const double> y,
                          std::span<const double> z, std::span<float> depths) const {
  const FloatEnvironment environment;
  for (std::size_t i = 0; i < depths.size(); ++i)
    depths[i] = static_cast<float>(depth_at({x[i], y[i], z[i]}));
}

CameraModel RayGenerator::model() const {
  const FloatEnvironment environment;
  const DVec3 right = glm::normalize(right_), up = -glm::normalize(down_);
  return {.world_from_camera =
              DMat4(DVec4(right, 0), DVec4(up, 0), DVec4(-forward_, 0), DVec4(position_, 1)),
          .center = center_,
          .pixels_per_unit = pixels_per_unit_,
          .distortion = distortion_,
          .depth = depth_};
}

}  // namespace microtrace
