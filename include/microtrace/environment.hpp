#pragma once
/// Environment light.

#include <microtrace/math.hpp>

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

namespace microtrace {

/// The radiance from each direction as a latitude-longitude map. The unit direction (x, y, z) is at
/// u = atan2(z, x) / (2 pi) + 1/2, v = acos(y) / pi, where (u, v) = (0, 0) is the upper left corner
/// and (1, 1) the lower right one. Values between pixel centers are interpolated bilinearly.
struct RadianceMap {
  std::uint32_t width = 0, height = 0;  ///< in pixels; each from 1 to 65536
  /// Linear Rec. 709, with components from 0 to kMaxRadiance; row by row from the upper left.
  std::vector<Vec3> pixels{};
};

/// Maximum value of a pixel's components, which keeps sums and products finite.
inline constexpr float kMaxRadiance = 1e9F;

/// The built-in environment: a gray room with large area lights, with mirror symmetry between left
/// and right.
struct Studio {};

/// To add a kind of environment, add a struct to the variant `content`, its radiance in
/// src/render/lights/environment/environment_light.cpp, its readers in src/io/scene_json/light.cpp
/// and src/cli/options/light_options.cpp, its members in docs/scene.schema.json and
/// docs/scene-format.md, its class in python/microtrace and python/src, and a line in
/// docs/light.md.
struct Environment {
  /// A Vec3 is uniform radiance, linear Rec. 709. Maps are never null.
  std::variant<Vec3, std::shared_ptr<const RadianceMap>, Studio> content{Vec3{1}};
  double rotation = 0;  ///< about +y in radians, counterclockwise as seen from above
  float intensity = 1;  ///< multiplies the content
  /// If true, path-traced pictures show the environment, with alpha 1, where camera rays hit
  /// nothing. Otherwise they show the scene's background there.
  bool is_background = false;
};

}  // namespace microtrace
