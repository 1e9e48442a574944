#pragma once
/// Cameras: the origins and directions of a picture's rays.
///
/// To add one: a struct here and in `Camera`, its rays in src/scene/camera.cpp, its rules in
/// src/scene/validate.cpp, its reader in src/io/scene_json/camera.cpp, its name in
/// src/io/sidecar/describe_picture.cpp, docs/scene.schema.json and docs/scene-format.md, golden
/// rays in tests/unit/camera_test.cpp. A lens also needs random numbers: a parameter of
/// RayGenerator, and a pair in src/render/sampling/dimensions.hpp that
/// src/render/samples/random_painter.cpp draws.

#include <microtrace/export.hpp>
#include <microtrace/math.hpp>
#include <microtrace/ray.hpp>

#include <cstdint>
#include <limits>
#include <optional>
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

using Camera = std::variant<PerspectiveCamera, OrthographicCamera, EnvironmentCamera>;

/// A picture's camera model for other programs. Camera space is right-handed, x right, y up, z
/// backward. The point (x, y, z) appears at pixel coordinates (center.x + pixels_per_unit x / w,
/// center.y - pixels_per_unit y / w), where w is -z for perspective cameras and 1 for orthographic
/// ones.
struct CameraModel {
  DMat4 world_from_camera{1};  ///< rigid
  DVec2 center{0};             ///< center of the picture in pixels
  /// The focal length in pixels, the same for x and y; orthographic: pixels per world unit;
  /// environment: 0.
  double pixels_per_unit = 0;
  DepthRange depth{};
};

/// The derivatives of a camera's ray with respect to pixel coordinates, to the right and down.
struct RayDifferential {
  DVec3 o_dx{0}, o_dy{0};
  DVec3 d_dx{0}, d_dy{0};
};

/// Generates the rays of one camera for one picture. Directions have unit length, computed in
/// float64 and rounded once.
class MICROTRACE_EXPORT RayGenerator {
 public:
  RayGenerator(const Camera& camera, ImageSize size);

  /// The ray through pixel coordinates (x, y): (0, 0) is the picture's upper left corner, (0.5,
  /// 0.5) the center of the first pixel; fractions and points outside the picture are allowed.
  [[nodiscard]] Ray operator()(double x, double y) const;

  /// The depth of a point along the viewing direction; for an environment camera its distance.
  [[nodiscard]] double depth(const DVec3& point) const;

  [[nodiscard]] CameraModel model() const;

  /// The differential of one of its rays, per pixel, in the limit of small steps. An environment
  /// camera's may have the opposite sign.
  [[nodiscard]] RayDifferential differential(const Ray& ray) const;

 private:
  friend class SegmentWidener;  // computes the inverse, from points to pixels

  // Perspective: the origin, and d ~ corner + x right + y down. Orthographic: the origin in the
  // same form, and a constant d. Environment: the frame.
  enum class Kind { perspective, orthographic, environment };
  Kind kind_;
  DVec3 position_, forward_, corner_, right_, down_;
  DepthRange depth_;
  ImageSize size_;
};

}  // namespace microtrace
