#pragma once
#include "render/lights/lighting.hpp"
#include "render/sampling/dimensions.hpp"
#include "render/sampling/sobol.hpp"

#include <microtrace/math.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace microtrace {

/// One path on its way.
struct PathState {
  sampling::Sobol sobol{};
  std::size_t slot = 0;  ///< in the batch
  Vec3 throughput{1};
  float pdf = 0;                ///< with which its last direction was chosen; 0: by the camera
  LightSampleContext from{};    ///< the surface that it leaves
  Vec3 absorption{0};           ///< of the medium that it is in, in powers of two per length
  int channel = 3;              ///< of a path through a dispersing medium, 0 to 2; 3: all
  float begin = 0, spread = 0;  ///< the width of what it stands for, at and from its origin
};

/// What all paths of a wave have in common at one of their vertices.
struct WaveStep {
  std::uint32_t depth = 1;  ///< straight parts so far, the one under way among them
  float sample_width = 1;   ///< of a pixel

  /// The number of that pair of random numbers.
  [[nodiscard]] std::uint32_t pair(std::uint32_t which) const {
    return sampling::kFirstVertexPair + (depth - 1) * sampling::kVertexPairs + which;
  }
  /// With which a path goes on at most; 1 where it always does.
  [[nodiscard]] float most_survival() const { return depth >= kFirstRoulette ? 0.95F : 1; }
  /// How much wider what a path stands for becomes by scattering: samples of such a pdf are
  /// about so far apart, and a quarter blurs nothing that is seen.
  [[nodiscard]] float spread(float pdf) const { return sample_width * 0.25F / std::sqrt(pdf); }

 private:
  /// Paths at least this long end at random if they carry little.
  static constexpr std::uint32_t kFirstRoulette = 4;
};

/// E. Veach, Robust Monte Carlo methods for light transport simulation, 1997, section 9.2.2.
inline float power_heuristic(float pdf, float other) {
  const float square = pdf * pdf;
  return square / (square + other * other);
}

}  // namespace microtrace
