#pragma once
/// Lights without extent, with the units of KHR_lights_punctual. They have no influence on flat
/// pictures.
///
/// To add one: a struct here and in `Light`, its reader in src/io/gltf/scene/lights.cpp.

#include <microtrace/math.hpp>

#include <limits>
#include <variant>

namespace microtrace {

/// Parallel light from infinitely far.
struct DirectionalLight {
  DVec3 direction{0, 0, -1};  ///< in which the light goes; world space, unit length
  Vec3 color{1};              ///< linear Rec. 709
  float intensity = 1;        ///< illuminance of a surface that faces it, lux
};

/// Light in all directions from one point.
struct PointLight {
  DVec3 position{0};                                       ///< world space
  Vec3 color{1};                                           ///< linear Rec. 709
  float intensity = 1;                                     ///< luminous intensity, candela
  double range = std::numeric_limits<double>::infinity();  ///< where it may be taken to end
};

/// Light in a cone from one point: whole within the inner angle, none from the outer on.
struct SpotLight {
  DVec3 position{0};          ///< world space
  DVec3 direction{0, 0, -1};  ///< of the cone's axis; world space, unit length
  Vec3 color{1};              ///< linear Rec. 709
  float intensity = 1;        ///< luminous intensity along the axis, candela
  double range = std::numeric_limits<double>::infinity();  ///< where it may be taken to end
  double inner_angle = 0;  ///< from the axis, radians, in [0, outer_angle)
  double outer_angle = 1;  ///< from the axis, radians, in (inner_angle, pi / 2]
};

using Light = std::variant<DirectionalLight, PointLight, SpotLight>;

}  // namespace microtrace
