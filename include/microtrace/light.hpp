#pragma once
/// Punctual lights, with the units of KHR_lights_punctual. They have no effect on flat pictures.
///
/// To add one: a struct here and in `Light`, its sampling and bounds in
/// src/render/lights/punctual.cpp, its readers in src/io/gltf/scene/lights.cpp and
/// src/io/scene_json/light.cpp, its members in docs/scene.schema.json and docs/scene-format.md, a
/// test in tests/statistical/path_test.cpp.

#include <microtrace/math.hpp>

#include <limits>
#include <variant>

namespace microtrace {

/// Parallel light from infinitely far away.
struct DirectionalLight {
  DVec3 direction{0, 0, -1};  ///< direction in which the light travels; world space, unit length
  Vec3 color{1};              ///< linear Rec. 709
  float intensity = 1;        ///< illuminance of a facing surface, lux
};

/// Light from a point in all directions.
struct PointLight {
  DVec3 position{0};                                       ///< world space
  Vec3 color{1};                                           ///< linear Rec. 709
  float intensity = 1;                                     ///< luminous intensity, candela
  double range = std::numeric_limits<double>::infinity();  ///< distance at which it may be cut off
};

/// Light from a point in a cone: full intensity within the inner angle, none from the outer angle
/// on.
struct SpotLight {
  DVec3 position{0};          ///< world space
  DVec3 direction{0, 0, -1};  ///< of the cone's axis; world space, unit length
  Vec3 color{1};              ///< linear Rec. 709
  float intensity = 1;        ///< luminous intensity along the axis, candela
  double range = std::numeric_limits<double>::infinity();  ///< distance at which it may be cut off
  double inner_angle = 0;  ///< from the axis, radians, in [0, outer_angle)
  double outer_angle = 1;  ///< from the axis, radians, in (inner_angle, pi / 2]
};

using Light = std::variant<DirectionalLight, PointLight, SpotLight>;

}  // namespace microtrace
