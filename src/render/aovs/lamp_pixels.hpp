#pragma once
#include <microtrace/camera.hpp>
#include <microtrace/scene.hpp>

#include <cstdint>
#include <vector>

namespace microtrace {

/// The pixels of a picture in which lamps may be visible: surfaces that emit the same light
/// everywhere.
class LampPixels {
 public:
  /// Finds those of the pixels in `window`.
  LampPixels(const Scene& scene, const RayGenerator& camera, const PixelRect& window);

  /// True for all pixels where a sample may show a lamp, and for others. The result doesn't
  /// depend on the window, which must contain the pixel.
  [[nodiscard]] bool contains(std::uint32_t x, std::uint32_t y) const {
    return is_in_[std::size_t{y - window_.y0} * window_.size().width + (x - window_.x0)];
  }

 private:
  PixelRect window_;
  std::vector<bool> is_in_;
};

}  // namespace microtrace
