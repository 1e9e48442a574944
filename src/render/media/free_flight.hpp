#pragma once
#include "render/media/medium.hpp"

#include <microtrace/math.hpp>

#include <optional>

namespace microtrace {

/// A path's flight through a scattering medium.
struct FreeFlight {
  /// The distance at which the path is scattered; nothing if it reaches the end of the medium.
  std::optional<double> distance{};
  Vec3 weight{1};  ///< factor of the throughput
};

/// Samples the flight of a path with this throughput, which must have a positive component, in a
/// medium that ends after the distance `end`, which may be infinite. u.x in [0, 1) determines the
/// distance, and u.y the color channel by whose extinction the distance is distributed. All
/// channels are weighted by the balance heuristic.
///
/// Channels are selected in proportion to their throughput. The sum of the throughput of all
/// channels is then the same after any flight that reaches the end, so no weights accumulate
/// however different the extinctions are. Selection in proportion to throughput times albedo (M.
/// Chiang et al., Practical and controllable subsurface scattering for production path tracing,
/// 2016) would have unbounded weights in channels that only absorb.
[[nodiscard]] FreeFlight sample_free_flight(const Medium& medium, const Vec3& throughput,
                                            double end, const Vec2& u);

}  // namespace microtrace
