#pragma once
/// A camera that frames a whole scene, for scenes without cameras.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/math.hpp>
#include <microtrace/scene.hpp>

#include <array>
#include <cstddef>
#include <optional>

namespace microtrace {

/// The direction from which a picture is taken. The default is the front, which in glTF faces +z,
/// from the right and above.
struct View {
  double azimuth = 30;    ///< degrees about +y: 0 is +z, 90 is +x; finite
  double elevation = 25;  ///< degrees above horizontal, in [-90, 90]; at 90 up is -z for azimuth 0
  double vertical_fov = 45;  ///< of the camera, in degrees, in (0, 180)
};

/// Finds a perspective camera for the picture's size. All bounded shapes are in the inner 96 % of
/// the picture, touch two opposite edges of this region, and are centered along the other axis. If
/// this would bring the camera closer than 1/64 of their bounding box's diagonal to the nearest
/// point, measured along the view, the camera keeps that distance. Planes, quadrics other than
/// ellipsoids, and vertices that are not finite are ignored. If all shapes coincide in one point,
/// the distance is 1; without shapes this point is the origin. Gives the same bits on every
/// machine, because it uses only + - * / and sqrt.
class MICROTRACE_EXPORT Framing {
 public:
  Framing(const View& view, ImageSize size);

  /// Adds a scene's shapes to those of previous scenes, for example the poses of an animation. All
  /// points of this class are in the first scene's coordinates.
  void add(const Scene& scene);

  [[nodiscard]] PerspectiveCamera camera() const;

  /// A camera that looks at the target from this distance, even if it doesn't see all shapes.
  /// distance > 0.
  [[nodiscard]] PerspectiveCamera camera_around(const DVec3& target, double distance) const;

  /// The center of the bounding box; (0, 0, 0) if there are no shapes.
  [[nodiscard]] DVec3 center() const;

  /// The first scene's origin.
  [[nodiscard]] DVec3 origin() const { return origin_.value_or(DVec3(0)); }

 private:
  void add(const DVec3& point);
  template <class Support>
  void add_support(const Support& support, const DVec3& shift);

  [[nodiscard]] bool is_empty() const { return !(low_.x <= high_.x); }
  [[nodiscard]] PerspectiveCamera camera_at(const DVec3& position) const;

  DVec3 right_, up_, back_;  // orthonormal
  double vertical_fov_;      // radians
  double slope_x_, slope_y_;
  // The outward normals of the frustum's four sides, and back; and the extent of the shapes along
  // each.
  std::array<DVec3, 5> directions_;
  std::array<double, 5> reach_;
  DVec3 low_, high_;  // the bounding box
  std::optional<DVec3> origin_;
};

[[nodiscard]] MICROTRACE_EXPORT PerspectiveCamera frame(const Scene& scene, const View& view,
                                                        ImageSize size);

/// The scene's first camera, or without cameras the frame() of the default view.
[[nodiscard]] MICROTRACE_EXPORT Camera default_camera(const Scene& scene, ImageSize size);

}  // namespace microtrace
