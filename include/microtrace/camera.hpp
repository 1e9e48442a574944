#pragma once
/// Cameras: the origins and directions of a picture's rays.
///
/// To add one: a struct here and in `Camera`, its rays in src/scene/camera.cpp, its rules in
/// src/scene/validate/validate.cpp, its reader in src/io/scene_json/camera.cpp, its name in
/// src/io/sidecar/describe_picture.cpp, docs/scene.schema.json and docs/scene-format.md, golden
/// rays in tests/unit/camera_test.cpp. A lens also needs random numbers: a parameter of
/// RayGenerator, and a pair in src/render/sampling/dimensions.hpp that
/// src/render/samples/random_painter.cpp draws.

#include <microtrace/export.hpp>
#include <microtrace/math.hpp>
#include <microtrace/ray.hpp>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <variant>

namespace microtrace {

struct ImageSize {
  std::uint32_t width = 640, height = 480;  ///< pixels, at least 1
};

/// A camera's position and orientation in world space. direction and up have any nonzero length and
/// are not parallel; up need not be perpendicular to direction.
struct Pose {
  DVec3 position{0};
  DVec3 direction{0, 0, -1};
  DVec3 up{0, 1, 0};
};

/// The visible range of depths along the viewing direction.
struct DepthRange {
  double near = 0;
  double far = std::numeric_limits<double>::infinity();
};

/// Perspective projection with square pixels onto the plane at distance focus. docs/derivations.md
/// derives its rays.
struct PerspectiveCamera {
  Pose pose{};
  double vertical_fov = 1;  ///< vertical field of view, radians, in (0, pi)
  double focus = 1;         ///< distance of the image plane; has no effect on rays
  /// If set, a window with this width / height is fitted into the picture, as glTF cameras require.
  /// If not, the vertical field of view spans the picture's height for any width.
  std::optional<double> aspect_ratio{};
  DepthRange depth{};
};

/// Orthographic projection with square pixels.
struct OrthographicCamera {
  Pose pose{};
  double height = 2;                     ///< height of the picture in world units
  std::optional<double> aspect_ratio{};  ///< as in PerspectiveCamera
  DepthRange depth{};
};

/// A latitude-longitude map of all directions, with the viewing direction in the middle.
struct EnvironmentCamera {
  Pose pose{};
};

/// Lens distortion of OpenCV's calibrateCamera, with the coefficients in OpenCV's order. The point
/// (x, y) of the plane at depth 1, x to the right and y down, moves to
///
///   x' = x s + 2 p1 x y + p2 (r^2 + 2 x^2)       r^2 = x^2 + y^2
///   y' = y s + p1 (r^2 + 2 y^2) + 2 p2 x y       s = (1 + k1 r^2 + k2 r^4 + k3 r^6) /
///                                                    (1 + k4 r^2 + k5 r^4 + k6 r^6)
///
/// If all coefficients are 0, there is no distortion.
struct RationalDistortion {
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0, k4 = 0, k5 = 0, k6 = 0;

  bool operator==(const RationalDistortion&) const = default;
};

/// The projection of OpenCV's fisheye module, equidistant if all coefficients are 0. A direction at
/// the angle a from the viewing direction appears at the distance
/// a (1 + k1 a^2 + k2 a^4 + k3 a^6 + k4 a^8) from the principal point, in units of the focal
/// lengths. a may exceed pi / 2.
struct FisheyeDistortion {
  double k1 = 0, k2 = 0, k3 = 0, k4 = 0;

  bool operator==(const FisheyeDistortion&) const = default;
};

using Distortion = std::variant<RationalDistortion, FisheyeDistortion>;

/// A real camera with the parameters of OpenCV's calibration. A picture of another size than
/// `image` shows the same view, scaled in x and in y, as resizing `image` would. Pixels have rays
/// within the largest disk around the principal axis in which the distortion is invertible
/// (docs/derivations.md); all others are black, or transparent if the picture has alpha, and hit
/// nothing.
struct CalibratedCamera {
  Pose pose{};                ///< see pose_from_opencv
  ImageSize image{};          ///< size of the calibration images
  double fx = 640, fy = 640;  ///< focal lengths in pixels of `image`
  /// The principal point in pixels of `image`, where pixel centers have integer coordinates, as in
  /// OpenCV. Where they have halves (RayGenerator, CameraModel), it is 0.5 more.
  double cx = 319.5, cy = 239.5;
  Distortion distortion{};
  DepthRange depth{};  ///< of a fisheye camera: the range of distances from the position
};

/// The pose of a camera with OpenCV's extrinsic parameters: a rigid transform from world space to
/// a camera space with x right, y down, z forward.
[[nodiscard]] MICROTRACE_EXPORT Pose pose_from_opencv(const DMat4& camera_from_world);

using Camera =
    std::variant<PerspectiveCamera, OrthographicCamera, EnvironmentCamera, CalibratedCamera>;

/// A picture's camera model for other programs. Camera space is right-handed, x right, y up, z
/// backward. The point (x, y, z) appears at pixel coordinates (center.x + pixels_per_unit.x x / w,
/// center.y - pixels_per_unit.y y / w), where w is -z for perspective cameras and 1 for
/// orthographic ones. For calibrated cameras w is -z, and `distortion` is applied to (x / w, -y /
/// w) before the scaling.
struct CameraModel {
  DMat4 world_from_camera{1};  ///< rigid
  DVec2 center{0};             ///< the principal point in pixels; the first pixel's center is 0.5
  /// The focal lengths in pixels; orthographic: pixels per world unit; environment: 0.
  DVec2 pixels_per_unit{0};
  std::optional<Distortion> distortion{};  ///< only of calibrated cameras
  DepthRange depth{};
};

/// The derivatives of a camera's ray with respect to pixel coordinates, to the right and down.
struct RayDifferential {
  DVec3 o_dx{0}, o_dy{0};
  DVec3 d_dx{0}, d_dy{0};
};

class Lens;

/// Generates the rays of one camera for one picture. Directions have unit length, computed in
/// float64 and rounded once.
class MICROTRACE_EXPORT RayGenerator {
 public:
  RayGenerator(const Camera& camera, ImageSize size);

  /// The ray through pixel coordinates (x, y): (0, 0) is the picture's upper left corner, (0.5,
  /// 0.5) the center of the first pixel; fractions and points outside the picture are allowed.
  /// Where a calibrated camera has no ray, the result has t_max = -1, so that it hits nothing.
  [[nodiscard]] Ray operator()(double x, double y) const;

  /// The rays through the centers of consecutive pixels in a row, (x, y) first; faster.
  void centers(std::uint32_t x, std::uint32_t y, std::span<Ray> rays) const;

  /// The pixel coordinates at which a point appears, inside the picture or not: the inverse of
  /// operator(), without regard to the depth range. Nothing for points that no ray reaches, such as
  /// those behind a perspective camera.
  [[nodiscard]] std::optional<DVec2> project(const DVec3& point) const;

  /// The depth of a point along the viewing direction, negative behind the camera; for an
  /// environment camera its distance.
  [[nodiscard]] double depth(const DVec3& point) const;
  /// Those of the points (x[i], y[i], z[i]), rounded. All spans have the same size.
  void depths(std::span<const double> x, std::span<const double> y, std::span<const double> z,
              std::span<float> depths) const;

  [[nodiscard]] CameraModel model() const;

  /// The differential of one of its rays, per pixel, in the limit of small steps. An environment
  /// camera's may have the opposite sign.
  [[nodiscard]] RayDifferential differential(const Ray& ray) const;

 private:
  friend class SegmentWidener;  // computes the inverse, from points to pixels

  [[nodiscard]] MICROTRACE_HIDDEN Ray ray_at(double x, double y) const;
  [[nodiscard]] MICROTRACE_HIDDEN double depth_at(const DVec3& point) const;

  // Perspective: the origin, and d ~ corner + x right + y down. Orthographic: the origin in the
  // same form, and a constant d. Environment and distorted: the frame, right, down and forward.
  enum class Kind { perspective, orthographic, environment, distorted };
  Kind kind_;
  DVec3 position_, forward_, corner_, right_, down_;
  DVec2 center_, pixels_per_unit_;  // as in CameraModel
  std::optional<Distortion> distortion_;
  std::shared_ptr<const Lens> lens_;  // distorted
  DepthRange depth_;
  ImageSize size_;
};

}  // namespace microtrace
