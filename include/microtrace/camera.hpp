#pragma once
/// Cameras: where the rays of a picture start and go.
///
/// To add one: a struct here and in `Camera`, its rays in src/scene/camera.cpp, its reader in
/// src/io/scene_json/scene.cpp and the JSON schema, a scene, golden rays in
/// tests/unit/camera_test.cpp.

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

/// Where a camera stands and looks, in world space. direction and up have any length and are not
/// parallel; up need not be perpendicular to direction.
struct Pose {
  DVec3 position{0};
  DVec3 direction{0, 0, -1};
  DVec3 up{0, 1, 0};
};

/// Depths along the viewing direction between which a camera sees.
struct DepthRange {
  double near = 0;
  double far = std::numeric_limits<double>::infinity();
};

/// Central projection with square pixels onto the plane at distance focus. docs/derivations.md
/// derives its rays.
struct PerspectiveCamera {
  Pose pose{};
  double vertical_fov = 1;  ///< full opening angle, radians, in (0, pi)
  double focus = 1;         ///< distance of the image plane; cancels out of every ray
  /// If set, a window of this width / height is fitted whole into the picture, as glTF cameras ask.
  /// If not, the vertical angle spans the picture's height whatever its width.
  std::optional<double> aspect_ratio{};
  DepthRange depth{};
};

/// Parallel projection with square pixels.
struct OrthographicCamera {
  Pose pose{};
  double height = 2;                     ///< of the picture, in world units
  std::optional<double> aspect_ratio{};  ///< as in PerspectiveCamera
  DepthRange depth{};
};

/// The whole sphere of directions: longitude across, latitude down, the viewing direction in the
/// middle.
struct EnvironmentCamera {
  Pose pose{};
};

using Camera = std::variant<PerspectiveCamera, OrthographicCamera, EnvironmentCamera>;

/// A camera of one picture as other programs want it. Camera space is right-handed, x right, y up,
/// z backward. A point (x, y, z) of it is seen at pixel coordinates (center.x + pixels_per_unit x /
/// w, center.y - pixels_per_unit y / w), where w is -z for perspective cameras and 1 for
/// orthographic ones.
struct CameraModel {
  DMat4 world_from_camera{1};  ///< rigid
  DVec2 center{0};             ///< of the picture, pixels
  /// The focal length in pixels, the same for x and y; orthographic: pixels per world unit;
  /// environment: 0.
  double pixels_per_unit = 0;
  DepthRange depth{};
};

/// How a camera's ray changes from one pixel to the next, to the right and down.
struct RayDifferential {
  DVec3 o_dx{0}, o_dy{0};
  DVec3 d_dx{0}, d_dy{0};
};

/// The rays of one camera for one picture. Directions have unit length, computed in float64 and
/// rounded once.
class MICROTRACE_EXPORT RayGenerator {
 public:
  RayGenerator(const Camera& camera, ImageSize size);

  /// The ray through pixel coordinates (x, y): (0, 0) is the picture's upper left corner, (0.5,
  /// 0.5) the centre of its first pixel; fractions and points outside the picture are allowed.
  [[nodiscard]] Ray operator()(double x, double y) const;

  /// How far a point lies from the camera along its viewing direction; for an environment camera,
  /// in its own direction.
  [[nodiscard]] double depth(const DVec3& point) const;

  [[nodiscard]] CameraModel model() const;

  /// Of one of its rays; per pixel, in the limit of small steps. An environment camera's may have
  /// the opposite sign.
  [[nodiscard]] RayDifferential differential(const Ray& ray) const;

 private:
  friend class SegmentWidener;  // goes the other way, from points to pixels

  // Perspective: origin and d ~ corner + x right + y down. Orthographic: the same for the origin, d
  // fixed. Environment: the frame itself.
  enum class Kind { perspective, orthographic, environment };
  Kind kind_;
  DVec3 position_, forward_, corner_, right_, down_;
  DepthRange depth_;
  ImageSize size_;
};

}  // namespace microtrace
