#pragma once
#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>

#include <optional>

namespace microtrace {

/// Light that may reach a point from one direction.
struct LightSample {
  Vec3 way{0};  ///< from the point to the light; any length where it is infinitely far
  bool is_far = false;
  Vec3 wi{0, 0, 1};   ///< its direction, of unit length
  Vec3 light{0};      ///< radiance / density; of lights without size the irradiance of a surface
                      ///< that faces them, over the share of samples that they get
  float density = 0;  ///< per solid angle; 0 for lights without size, which no path can meet
  std::optional<PrimitiveId> target{};  ///< what shines, if it is a surface

  /// Makes it one of several that are chosen among, by the share of samples that it gets.
  void take_share(float share) {
    light /= share;
    density *= share;
  }
};

}  // namespace microtrace
