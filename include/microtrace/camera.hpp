#pragma once
/// Cameras, which define the origins and directions of a picture's rays.
///
/// To add a camera, add a struct here and to the variant `Camera`, its rays in
/// src/scene/camera.cpp, its rules in src/scene/validate/validate.cpp, its reader in
/// src/io/scene_json/camera.cpp, its name in src/io/sidecar/describe_picture.cpp, its members in
/// docs/scene.schema.json and docs/scene-format.md, its class in python/microtrace and python/src,
/// and golden rays in tests/unit/scene/camera_test.cpp. A camera with a lens also needs its case in
/// RayGenerator::through_lens.

#include <microtrace/export.hpp>
#include <microtrace/frustum.hpp>
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

/// Pixels [x0, x1) x [y0, y1), counted from the picture's upper left corner.
struct PixelRect {
  std::uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  [[nodiscard]] ImageSize size() const { return {.width = x1 - x0, .height = y1 - y0}; }
  [[nodiscard]] bool operator==(const PixelRect&) const = default;
};

/// A camera's position and orientation, in scene coordinates for the cameras of a Scene. direction
/// and up may have any nonzero length and must not be parallel; up need not be perpendicular to
/// direction.
struct Pose {
  DVec3 position{0};
  DVec3 direction{0, 0, -1};
  DVec3 up{0, 1, 0};
};

/// The visible range of depths along the viewing direction, in world units.
struct DepthRange {
  double near = 0;
  double far = std::numeric_limits<double>::infinity();
};

/// Perspective projection with square pixels. docs/derivations.md derives the rays.
struct PerspectiveCamera {
  Pose pose{};
  double vertical_fov = 1;  ///< vertical field of view, radians, in (0, pi)
  /// Depth of the image plane. It has no effect on the rays of a pinhole. With a lens, points at
  /// this depth are sharp.
  double focus = 1;
  /// Radius of a thin lens in world units, not negative; 0 is a pinhole. Only samples of Monte
  /// Carlo integrators pass through the lens; all other rays pass through its center.
  double lens_radius = 0;
  /// If set, a window with this ratio of width to height is fitted into the picture, as glTF
  /// cameras require. If not set, the vertical field of view spans the picture's height for any
  /// width.
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

/// Latitude-longitude projection of all directions, with the viewing direction in the middle of the
/// picture.
struct EnvironmentCamera {
  Pose pose{};
};

/// The lens distortion model of OpenCV's calibrateCamera, with the coefficients in OpenCV's order.
/// The point (x, y) on the plane at depth 1, with x to the right and y down, moves to
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
/// the angle a from the viewing direction (radians, may exceed pi / 2) appears at a distance from
/// the principal point, in units of the focal lengths, of a (1 + k1 a^2 + k2 a^4 + k3 a^6 + k4
/// a^8).
struct FisheyeDistortion {
  double k1 = 0, k2 = 0, k3 = 0, k4 = 0;

  bool operator==(const FisheyeDistortion&) const = default;
};

using Distortion = std::variant<RationalDistortion, FisheyeDistortion>;

/// A real camera with the parameters of OpenCV's calibration. A picture whose size differs from
/// `image` shows the same view, scaled in x and in y as if a picture of size `image` had been
/// resized. Only pixels within the largest disk around the principal axis in which the distortion
/// is invertible have rays (docs/derivations.md). All other pixels hit nothing; they are black, or
/// transparent if the picture has alpha.
struct CalibratedCamera {
  Pose pose{};                ///< see pose_from_opencv
  ImageSize image{};          ///< size of the calibration images, pixels
  double fx = 640, fy = 640;  ///< focal lengths in pixels of `image`
  /// The principal point in pixels of `image`. Pixel centers have integer coordinates here, as in
  /// OpenCV. RayGenerator and CameraModel place pixel centers at half-integers, so their
  /// coordinates are larger by 0.5.
  double cx = 319.5, cy = 239.5;
  Distortion distortion{};
  DepthRange depth{};  ///< for FisheyeDistortion, the range of distances from the position
};

/// Returns the pose of a camera with OpenCV's extrinsic parameters. `camera_from_world` must be a
/// rigid transform from world space to camera space with x right, y down and z forward.
[[nodiscard]] MICROTRACE_EXPORT Pose pose_from_opencv(const DMat4& camera_from_world);

using Camera =
    std::variant<PerspectiveCamera, OrthographicCamera, EnvironmentCamera, CalibratedCamera>;

/// A picture's camera as a projection, for other programs. Camera space is right-handed, with x
/// right, y up and z backward. The point (x, y, z) appears at pixel coordinates (center.x +
/// pixels_per_unit.x x / w, center.y - pixels_per_unit.y y / w), where w is 1 for orthographic
/// cameras and -z for perspective and calibrated ones. For calibrated cameras `distortion` is
/// applied to (x / w, -y / w) before the scaling.
struct CameraModel {
  DMat4 world_from_camera{1};  ///< a rigid transform
  DVec2 center{0};             ///< the principal point in pixels; (0.5, 0.5) is the first pixel's
                               ///< center
  /// The focal lengths in pixels; for orthographic cameras, pixels per world unit; for environment
  /// cameras, 0.
  DVec2 pixels_per_unit{0};
  std::optional<Distortion> distortion{};  ///< set for calibrated cameras only
  DepthRange depth{};
};

/// The derivatives of a camera ray's origin o and direction d with respect to the pixel coordinates
/// x (to the right) and y (down).
struct RayDifferential {
  DVec3 o_dx{0}, o_dy{0};
  DVec3 d_dx{0}, d_dy{0};
};

class Lens;

/// Generates the rays of one camera for one picture. Directions have unit length; they are computed
/// in float64 and rounded to float32 once.
class MICROTRACE_EXPORT RayGenerator {
 public:
  RayGenerator(const Camera& camera, ImageSize size);

  /// Returns the ray through the pixel coordinates (x, y), where (0, 0) is the picture's upper left
  /// corner and (0.5, 0.5) the center of the first pixel. Fractions and points outside the picture
  /// are allowed. Where a calibrated camera has no ray, returns a ray with t_max = -1, which hits
  /// nothing.
  [[nodiscard]] Ray operator()(double x, double y) const;

  /// True if the camera has a lens with a radius above 0.
  [[nodiscard]] bool has_lens() const { return has_lens_; }
  /// Returns the ray through the point `on_lens` of the unit disk, scaled to the lens, which meets
  /// the ray of operator() at the depth of focus (docs/derivations.md). The camera must have a
  /// lens.
  [[nodiscard]] Ray through_lens(double x, double y, const DVec2& on_lens) const;

  /// Computes the rays through the centers of consecutive pixels of a row, starting at pixel (x,
  /// y). Faster than single calls.
  void centers(std::uint32_t x, std::uint32_t y, std::span<Ray> rays) const;
  /// Computes the rays through the centers of a block of pixels, `width` pixels wide and starting
  /// at pixel (x, y), row by row. rays.size() must be a multiple of `width`. Each t_min is at least
  /// `least_t_min`.
  void centers(std::uint32_t x, std::uint32_t y, std::uint32_t width, float least_t_min,
               std::span<Ray> rays) const;
  /// Sets rays[i] to the ray through the pixel coordinates (x[i], y[i]), with a t_min of at least
  /// `least_t_min`. All spans must have the same size. Faster than single calls.
  void through(std::span<const double> x, std::span<const double> y, float least_t_min,
               std::span<Ray> rays) const;

  /// Returns a frustum that contains all rays of operator() with x0 <= x <= x1 and y0 <= y <= y1.
  /// Returns nothing for cameras whose directions are not linear in x and y.
  [[nodiscard]] std::optional<Frustum> frustum(double x0, double y0, double x1, double y1) const;

  /// Returns the pixel coordinates at which a point appears, whether inside the picture or not.
  /// This is the inverse of operator() and ignores the depth range. Returns nothing for points that
  /// no ray reaches, such as points behind a perspective camera.
  [[nodiscard]] std::optional<DVec2> project(const DVec3& point) const;

  /// Returns the depth of a point along the viewing direction, which is negative behind the camera.
  /// For an environment camera, returns the distance of the point.
  [[nodiscard]] double depth(const DVec3& point) const;
  /// Computes the depths of the points (x[i], y[i], z[i]), rounded to float32. All spans must have
  /// the same size.
  void depths(std::span<const double> x, std::span<const double> y, std::span<const double> z,
              std::span<float> depths) const;

  [[nodiscard]] CameraModel model() const;

  /// Returns the derivatives of a ray of this camera per pixel. For an environment camera, their
  /// signs may be reversed.
  [[nodiscard]] RayDifferential differential(const Ray& ray) const;
  /// The distance between the points of a ray and of the ray one pixel below is about begin +
  /// spread times the distance from the camera, in scene units.
  struct RowSpacing {
    double begin = 0, spread = 0;
  };
  /// Computes the spacings of the rays with the directions (d[0][i], d[1][i], d[2][i]). Faster than
  /// differential(), in particular for sixteen rays of a perspective camera.
  void row_spacings(const float* const (&d)[3], std::span<RowSpacing> spacings) const;

 private:
  friend class SegmentWidener;  // projects points to pixels

  [[nodiscard]] MICROTRACE_HIDDEN Ray ray_at(double x, double y) const;
  [[nodiscard]] MICROTRACE_HIDDEN double depth_at(const DVec3& point) const;

  // Perspective: position_ is the origin, and d is proportional to corner_ + x right_ + y down_.
  // Orthographic: the origin is corner_ + x right_ + y down_, and d is constant. Environment and
  // distorted: right_, down_ and forward_ are the camera's axes.
  enum class Kind { perspective, orthographic, environment, distorted };
  Kind kind_;
  DVec3 position_, forward_, corner_, right_, down_;
  DVec2 center_, pixels_per_unit_;  // as in CameraModel
  std::optional<Distortion> distortion_;
  std::shared_ptr<const Lens> lens_;  // for Kind::distorted
  bool has_lens_ = false;
  double focus_ = 1;
  DVec3 lens_right_{0}, lens_down_{0};  // from the center of the lens to its edge
  DepthRange depth_;
  ImageSize size_;
};

}  // namespace microtrace
