#pragma once
/// Light from all around the scene.

#include <microtrace/math.hpp>

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

namespace microtrace {

/// The radiance that comes from each direction, as a latitude-longitude map: the direction (x, y,
/// z) of unit length lies at u = atan2(z, x) / 2 pi + 1/2, v = acos(y) / pi, where (0, 0) is the
/// upper left corner and (1, 1) the lower right one. Between the pixels' centres it is bilinear.
struct RadianceMap {
  std::uint32_t width = 0, height = 0;  ///< at least 1, at most 65536
  /// Linear Rec. 709, from 0 to kMaxRadiance; row by row from the upper left.
  std::vector<Vec3> pixels{};
};

/// No pixel of a map is brighter, so that sums and products of light stay finite.
inline constexpr float kMaxRadiance = 1e9F;

/// The built-in environment: a grey room with large soft lamps, the same on the left and the right.
struct Studio {};

/// To add a kind: a struct for it in `content`, its radiance in src/render/lights.
struct Environment {
  /// A Vec3 is the radiance from everywhere, linear Rec. 709. Maps are never null.
  std::variant<Vec3, std::shared_ptr<const RadianceMap>, Studio> content{Vec3{1}};
  double rotation = 0;  ///< of the content about +y, radians, anticlockwise as seen from above
  float intensity = 1;  ///< multiplies the content
  /// Whether pictures with light show it where a ray of the camera hits nothing, with alpha 1; if
  /// not, the scene's background is there.
  bool is_background = false;
};

}  // namespace microtrace
