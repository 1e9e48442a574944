#pragma once
#include "render/integrators/power_heuristic.hpp"
#include "render/lights/lighting.hpp"
#include "render/media/nested_media.hpp"
#include "render/sampling/dimensions.hpp"
#include "render/sampling/sobol.hpp"

#include <microtrace/math.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace microtrace {

/// The state of one path.
struct PathState {
  sampling::Sobol sobol{};
  std::size_t slot = 0;  ///< index in the batch
  Vec3 throughput{1};
  float pdf = 0;                       ///< pdf of the last direction; 0 for camera rays
  LightSampleContext from{};           ///< the previous vertex
  const NestedMedia* media = nullptr;  ///< the current media
  int channel = 3;  ///< color channel in a dispersive medium, 0 to 2; 3 for all channels
  float begin = 0, spread = 0;    ///< footprint width at the origin, and growth with distance
  std::uint32_t scatterings = 0;  ///< number of scattering events in media
  bool is_scattered =
      false;  ///< true if the previous vertex is in a medium, where no light is sampled
};

/// Parameters common to all paths of a wavefront at one bounce.
struct WaveStep {
  std::uint32_t depth = 1;  ///< number of the current path segment, counted from 1
  float sample_width = 1;   ///< distance between samples, in pixels

  /// The number of the pair of random numbers `which` at this bounce.
  [[nodiscard]] std::uint32_t pair(std::uint32_t which) const {
    return sampling::kFirstVertexPair + (depth - 1) * sampling::kVertexPairs + which;
  }
  /// The number of the pair of random numbers for a flight through a scattering medium.
  [[nodiscard]] std::uint32_t flight_pair() const { return sampling::kFirstFlightPair + depth - 1; }
  /// Maximum survival probability of Russian roulette; 1 disables it.
  [[nodiscard]] float most_survival() const { return depth >= kFirstRoulette ? 0.95F : 1; }
  /// Growth of the path's footprint after scattering with this pdf: a quarter of the mean sample
  /// spacing, too small to blur visibly.
  [[nodiscard]] float spread(float pdf) const { return sample_width * 0.25F / std::sqrt(pdf); }

 private:
  /// Russian roulette starts at this path length.
  static constexpr std::uint32_t kFirstRoulette = 4;
};

}  // namespace microtrace
