#pragma once
/// Survival probabilities of Russian roulette.

#include "scene/math/luminance.hpp"
#include "simd/vector3.hpp"

namespace microtrace {

/// The survival probability of a path with this throughput, which may be greater than 1. With twice
/// the throughput, the error after equal time is up to 12 % less than with the throughput itself.
template <int N>
Float<N> survival_of(const Floats3<N>& throughput) {
  return 2 * greatest_component(throughput);
}

/// Limits survival probabilities to `most`, so that paths between white surfaces end. Each time,
/// the throughput of such a path grows. Paths that survived often would be rare and very bright, so
/// the limit is higher for paths with a great throughput.
template <int N>
Float<N> limited_survival(const Float<N>& wanted, const Floats3<N>& throughput, float most) {
  constexpr float kGreat = 4, kMostOfGreat = 0.995F;
  const auto is_great = greatest_component(throughput) > kGreat;
  return smaller_of(wanted, is_great ? all<N>(kMostOfGreat) : all<N>(most));
}

/// The survival probability of a path with this throughput, if it had been sampled by the BSDF
/// only. It is in proportion to the light that the path is expected to find, not to the throughput,
/// which is small in the directions that the guide prefers (J. Vorba and J. Křivánek,
/// Adjoint-driven Russian roulette and splitting in light transport simulation, 2016). A negative
/// brightness is unknown.
template <int N>
Float<N> guided_survival_of(const Floats3<N>& throughput, const Float<N>& brightness) {
  constexpr float kSurvival = 3, kLeast = 0.1F;
  const Float<N> expected = larger_of(Float<N>(kSurvival * luminance(throughput) * brightness),
                                      Float<N>(kLeast * greatest_component(throughput)));
  return brightness < 0 ? survival_of<N>(throughput) : expected;
}

}  // namespace microtrace
