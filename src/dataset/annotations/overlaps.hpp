#pragma once
/// Counts the objects that a ray can hit, so that all hits are computed only where objects may hide
/// each other.

#include <microtrace/camera.hpp>
#include <microtrace/scene.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace microtrace::dataset {

/// Returns for each object a part of the window outside which no ray through a pixel center hits
/// the object. `rays` must be the camera's rays in the coordinates of the scene.
[[nodiscard]] std::vector<PixelRect> parts_of_objects(const Scene& scene, const Camera& camera,
                                                      const RayGenerator& rays,
                                                      const PixelRect& window);

/// For each pixel of a window, the number of parts that contain it.
class Overlaps {
 public:
  Overlaps(const std::vector<PixelRect>& parts, const PixelRect& window);

  /// Returns the number of parts that contain the pixel.
  [[nodiscard]] std::uint32_t at(std::uint32_t x, std::uint32_t y) const {
    return counts_[std::size_t{y - window_.y0} * (width_ + 1) + (x - window_.x0)];
  }

  /// Returns a rectangle that contains all pixels that two or more parts contain. It may be empty.
  [[nodiscard]] const PixelRect& several() const { return several_; }

 private:
  PixelRect window_, several_;
  std::uint32_t width_;
  std::vector<std::uint32_t> counts_;  // row by row; each row has an additional column
};

}  // namespace microtrace::dataset
