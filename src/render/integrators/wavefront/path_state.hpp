#pragma once
#include "render/lanes/ray_arrays.hpp"
#include "render/lights/emitters.hpp"
#include "render/lights/power_heuristic.hpp"
#include "render/sampling/dimensions.hpp"
#include "render/sampling/sobol.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/math.hpp>
#include <microtrace/ray.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace microtrace {

/// The paths of a wavefront and their current rays, in one array per component.
struct alignas(64) PathColumns {
  PathFloats o[3], d[3];  ///< the ray
  PathFloats t_min, t_max;
  PathNumbers left;        ///< the primitive that the ray leaves; unused for camera rays
  PathNumbers key, index;  ///< of sampling::Sobol
  PathNumbers slot;        ///< index in the batch
  PathFloats throughput[3];
  PathFloats pdf;                   ///< pdf of the ray's direction; 0 for camera rays
  PathFloats from_p[3], from_n[3];  ///< LightSampleContext of the previous vertex
  PathNumbers media;                ///< the current media: a number of NestedMediaTable
  PathNumbers scatterings;          ///< number of scattering events in media
  PathNumbers is_scattered;  ///< 1 if the previous vertex is in a medium, where no light is sampled
  PathNumbers channel;       ///< color channel in a dispersive medium, 0 to 2; 3 for all channels
  PathFloats begin, spread;  ///< footprint width at the origin, and growth with distance

  [[nodiscard]] Ray ray(std::size_t i) const {
    return {.o = vector_of(o, i), .t_min = t_min[i], .d = vector_of(d, i), .t_max = t_max[i]};
  }
  [[nodiscard]] sampling::Sobol sobol(std::size_t i) const { return {key[i], index[i]}; }
  /// Moves the paths with these numbers, which are in ascending order, to the front.
  void keep(std::span<const std::uint32_t> kept) {
    const auto keep_column = [&](auto& column) {
      for (std::size_t k = 0; k < kept.size(); ++k) column[k] = column[kept[k]];
    };
    const auto keep_all = [&](auto&... columns) { (keep_column(columns), ...); };
    for (int axis = 0; axis < 3; ++axis)
      keep_all(o[axis], d[axis], throughput[axis], from_p[axis], from_n[axis]);
    keep_all(t_min, t_max, left, key, index, slot, pdf, media, scatterings, is_scattered, channel,
             begin, spread);
  }
  [[nodiscard]] LightSampleContext from(std::size_t i) const {
    return {.p = vector_of(from_p, i), .n = vector_of(from_n, i)};
  }
};

/// Shadow rays in one array per component, and the light that arrives unless they are occluded.
struct alignas(64) ShadowColumns : RayArrays {
  PathNumbers target;  ///< the emissive surface at which the ray ends, or LightSamples::kNoTarget
  PathNumbers slot;    ///< of the path
  PathNumbers media;   ///< the media around the origin, by their number in the NestedMediaTable
  PathFloats light[3];
};

/// Parameters common to all paths of a wavefront at one bounce.
struct WaveStep {
  std::uint32_t depth = 1;   ///< number of the current path segment, counted from 1
  float sample_width = 1;    ///< distance between samples, in pixels
  bool is_spec = false;      ///< true for BsdfModel::spec
  bool has_textures = true;  ///< true if footprints matter

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
