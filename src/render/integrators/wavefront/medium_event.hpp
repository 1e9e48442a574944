#pragma once
#include "render/integrators/wavefront/path_state.hpp"
#include "render/media/medium.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/ray.hpp>

#include <optional>

namespace microtrace {

/// The maximum number of scattering events of a path, so that paths in white media without an end
/// terminate. A path has left a half-space of a white medium after fewer events in 99 of 100 cases.
inline constexpr std::uint32_t kMostScatterings = 4096;

/// The state of a path in a medium.
struct MediumPath {
  sampling::Sobol sobol;
  Vec3 throughput{1};
  float pdf = 0;                ///< pdf of the last direction
  float begin = 0, spread = 0;  ///< see PathColumns
  std::uint32_t scatterings = 0;
};

/// The result of a path's flight along its ray in a medium.
struct MediumEvent {
  bool arrives = true;             ///< true if the path reaches the surface
  double distance = 0;             ///< distance of the scattering event, if there is one
  std::optional<Ray> scattered{};  ///< the next ray of a path that is scattered before
};

/// Samples a flight in the medium along the ray, up to its hit at this distance or,
/// if there is no hit, without an end. Updates the path's state. A path that neither arrives nor is
/// scattered has ended. Next rays don't start on a surface, and never on the other side of one.
[[nodiscard]] MediumEvent cross_medium(const Bvh& bvh, const WaveStep& step, const Ray& ray,
                                       const std::optional<Hit>& hit, float distance,
                                       const Medium& medium, MediumPath& path);

}  // namespace microtrace
