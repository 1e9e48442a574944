#pragma once
/// The camera rays of pictures.

#include <microtrace/camera.hpp>
#include <microtrace/film.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/scene.hpp>

#include <algorithm>
#include <cmath>
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

  /// Sets `rays` to the rays through the centers of the tile's pixels, row by row.
  void centers(const PixelRect& tile, std::span<Ray> rays) const {
    camera_.centers(tile.x0, tile.y0, tile.size().width, t_min_, rays);
  }

 private:
  const RayGenerator& camera_;
  float t_min_;
};

}  // namespace microtrace
