#pragma once
#include "render/luminance.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>

#include <cmath>
#include <limits>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {

/// Of a density above 0 the nearest whose square has a place in float32.
[[nodiscard]] inline float limited_density(double density) {
  constexpr double most = 0x1p60;
  return static_cast<float>(density < most ? glm::max(density, 1 / most) : most);
}

/// Light that may reach a point from one direction.
struct LightSample {
  Vec3 way{0};  ///< from the point to the light; any length where it is infinitely far
  bool is_far = false;
  Vec3 wi{0, 0, 1};   ///< its direction, of unit length
  Vec3 light{0};      ///< radiance / density; of lights without size the irradiance of a surface
                      ///< that faces them, over the share of samples that they get
  float density = 0;  ///< per solid angle; 0 for lights without size, which no path can meet
  std::optional<PrimitiveId> target{};  ///< what shines, if it is a surface
};

/// The same before it is one of many lights, in float64: squares of all distances in float32 have
/// a place there.
struct FoundLight {
  DVec3 way{0};
  bool is_far = false;
  Vec3 wi{0, 0, 1};
  DVec3 light{0};
  double density = 0;
  std::optional<PrimitiveId> target{};

  /// As one of several that are chosen among, by the share of samples that it gets.
  [[nodiscard]] LightSample with_share(double share) const {
    // Shadow rays need a direction that float32 has.
    using Limits = std::numeric_limits<float>;
    const double reach = std::sqrt(glm::dot(way, way));
    const bool has_way = reach >= double{Limits::min()} && reach <= double{Limits::max()};
    return {.way = has_way ? Vec3(way) : wi,
            .is_far = is_far || !has_way,
            .wi = wi,
            .light = Vec3(glm::min(light / share, DVec3(kBrightest))),
            .density = density > 0 ? limited_density(density * share) : 0,
            .target = target};
  }
};

}  // namespace microtrace
