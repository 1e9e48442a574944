#pragma once
/// The camera rays of pictures.

#include <microtrace/camera.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/scene.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

namespace microtrace {

/// The rays of a camera, limited to the open interval (scene.epsilon, infinity). Because a ray's
/// interval is closed, t_min is the next float32 above epsilon.
class CameraRays {
 public:
  /// The camera must outlive this object.
  CameraRays(const RayGenerator& camera, const Scene& scene)
      : camera_(camera),
        t_min_(std::nextafter(scene.epsilon, std::numeric_limits<float>::infinity())) {}

  /// The ray through the pixel coordinates (x, y), as in RayGenerator.
  [[nodiscard]] Ray operator()(double x, double y) const {
    Ray ray = camera_(x, y);
    ray.t_min = std::max(ray.t_min, t_min_);
    return ray;
  }

  /// The rays through the centers of consecutive pixels in a row.
  void centers(std::uint32_t x, std::uint32_t y, std::span<Ray> rays) const {
    camera_.centers(x, y, rays);
    for (Ray& ray : rays) ray.t_min = std::max(ray.t_min, t_min_);
  }

 private:
  const RayGenerator& camera_;
  float t_min_;
};

}  // namespace microtrace
