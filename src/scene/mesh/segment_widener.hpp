#pragma once
/// Computes the world-space width of lines that are one pixel wide.

#include <microtrace/camera.hpp>
#include <microtrace/math.hpp>

#include <array>
#include <optional>

namespace microtrace {

/// A segment as a flat quadrilateral facing the camera.
struct WideSegment {
  std::array<Vec3, 4> corners;  ///< counterclockwise as seen from the camera; two at each end
  double start, end;            ///< positions of its ends on the segment, in [0, 1]
};

class SegmentWidener {
 public:
  SegmentWidener(const Camera& camera, ImageSize size);

  /// Widens the segment from a to b. Returns nothing if the camera sees no part of it.
  [[nodiscard]] std::optional<WideSegment> operator()(const Vec3& a, const Vec3& b) const;

 private:
  /// Pixel coordinates are (x, y) / w; depth is measured along the viewing direction.
  struct Projected {
    double x, y, w, depth;
  };
  void allow_for_lens();
  [[nodiscard]] Projected project(const DVec3& p) const;
  [[nodiscard]] std::optional<WideSegment> planar(const DVec3& a, const DVec3& b) const;
  [[nodiscard]] std::optional<WideSegment> spherical(const DVec3& a, const DVec3& b) const;

  RayGenerator rays_;
  bool is_planar_;
  // For planar projections: the world-space steps from pixel to pixel at depth 1, and the rectangle
  // in pixels to which segments are clipped. For cameras with a lens, the pixels are those of the
  // undistorted picture.
  DVec3 right_, down_;
  DVec2 low_, high_;
  double width_ = 1;  // width of a line in these pixels
  double angle_ = 0;  // angle of a pixel for spherical projections
};

}  // namespace microtrace
