#pragma once
/// The camera rays of pictures.

#include "render/film/sample_pattern.hpp"
#include "render/sampling/warps.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/film.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/scene.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
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
  [[nodiscard]] Ray operator()(double x, double y) const { return limited(camera_(x, y)); }
  /// The ray of a sample. Two random numbers select a point on the camera's lens, if it has one.
  [[nodiscard]] Ray sample(double x, double y, const Vec2& u) const {
    if (!has_lens()) return (*this)(x, y);
    return limited(camera_.through_lens(x, y, DVec2(sampling::unit_disk(u))));
  }
  [[nodiscard]] bool has_lens() const { return camera_.has_lens(); }

  /// Sets rays[i] to the ray through the pixel coordinates (x[i], y[i]).
  void through(std::span<const double> x, std::span<const double> y, std::span<Ray> rays) const {
    camera_.through(x, y, t_min_, rays);
  }

  /// The rays through these pixels from the offset `least` to `greatest` of each, as in
  /// RayGenerator. They don't pass through a lens.
  [[nodiscard]] std::optional<Frustum> frustum(const PixelRect& pixels, const PixelOffset& least,
                                               const PixelOffset& greatest) const {
    std::optional<Frustum> result =
        camera_.frustum(pixels.x0 + least.x, pixels.y0 + least.y, pixels.x1 - 1 + greatest.x,
                        pixels.y1 - 1 + greatest.y);
    if (result) result->greatest_t_min = std::max(result->greatest_t_min, double{t_min_});
    return result;
  }

  /// Sets `rays` to the rays through the centers of the tile's pixels, row by row.
  void centers(const PixelRect& tile, std::span<Ray> rays) const {
    camera_.centers(tile.x0, tile.y0, tile.size().width, t_min_, rays);
  }

 private:
  [[nodiscard]] Ray limited(Ray ray) const {
    ray.t_min = std::max(ray.t_min, t_min_);
    return ray;
  }

  const RayGenerator& camera_;
  float t_min_;
};

}  // namespace microtrace
