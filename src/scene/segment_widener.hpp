#pragma once
/// How wide a line must be to cover a pixel.

#include <microtrace/camera.hpp>
#include <microtrace/math.hpp>

#include <array>
#include <optional>

namespace microtrace {

/// A segment as a flat quadrilateral that faces the camera.
struct WideSegment {
  std::array<Vec3, 4> corners;  ///< anticlockwise as the camera sees them; two at each end
  double start, end;            ///< where its ends lie on the segment, in [0, 1]
};

class SegmentWidener {
 public:
  SegmentWidener(const Camera& camera, ImageSize size);

  /// Nothing if the camera sees none of the segment from a to b.
  [[nodiscard]] std::optional<WideSegment> operator()(const Vec3& a, const Vec3& b) const;

 private:
  /// Pixel coordinates are (x, y) / w; depth is along the viewing direction.
  struct Projected {
    double x, y, w, depth;
  };
  [[nodiscard]] Projected project(const DVec3& p) const;
  [[nodiscard]] std::optional<WideSegment> planar(const DVec3& a, const DVec3& b) const;
  [[nodiscard]] std::optional<WideSegment> spherical(const DVec3& a, const DVec3& b) const;

  RayGenerator rays_;
};

}  // namespace microtrace
