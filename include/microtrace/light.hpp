#pragma once
/// Punctual lights, in the units of KHR_lights_punctual. Lights have no effect on flat pictures.
/// Positions are in scene coordinates (see Scene::origin).
///
/// To add a light, add a struct here and to the variant `Light`, its sampling and bounds in
/// src/render/lights/punctual.cpp, its readers in src/io/gltf/scene/lights.cpp and
/// src/io/scene_json/light.cpp, its members in docs/scene.schema.json and docs/scene-format.md, its
/// class in python/microtrace and python/src, and a test in tests/statistical/path_test.cpp.

#include <microtrace/math.hpp>

#include <limits>
#include <variant>

namespace microtrace {

/// Parallel light from infinitely far away.
struct DirectionalLight {
  DVec3 direction{0, 0, -1};  ///< direction in which the light travels; world space, unit length
  Vec3 color{1};              ///< linear Rec. 709
  float intensity = 1;        ///< illuminance of a surface perpendicular to the light, lux
};

/// Light from a point in all directions.
struct PointLight {
  DVec3 position{0};                                       ///< scene coordinates
  Vec3 color{1};                                           ///< linear Rec. 709
  float intensity = 1;                                     ///< luminous intensity, candela
  double range = std::numeric_limits<double>::infinity();  ///< world units; the light fades to zero
                                                           ///< at this distance
};

/// Light from a point into a cone. The intensity is full within the inner angle, falls off to the
/// outer angle, and is zero from there on.
struct SpotLight {
  DVec3 position{0};          ///< scene coordinates
  DVec3 direction{0, 0, -1};  ///< direction of the cone's axis; world space, unit length
  Vec3 color{1};              ///< linear Rec. 709
  float intensity = 1;        ///< luminous intensity along the axis, candela
  double range = std::numeric_limits<double>::infinity();  ///< world units; the light fades to zero
                                                           ///< at this distance
  double inner_angle = 0;  ///< angle from the axis, radians, in [0, outer_angle)
  double outer_angle = 1;  ///< angle from the axis, radians, in (inner_angle, pi / 2]
};

using Light = std::variant<DirectionalLight, PointLight, SpotLight>;

}  // namespace microtrace
