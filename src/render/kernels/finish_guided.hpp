#pragma once
/// Finishes the sampling of directions by a mixture of BSDF and guide.

#include "render/kernels/kernel.hpp"
#include "render/luminance.hpp"
#include "simd/vector3.hpp"

namespace microtrace {

/// The survival probability of a path with this throughput, if it had been sampled by the BSDF
/// only. It is in proportion to the light that the path is expected to find, not to the throughput,
/// which is small in the directions that the guide prefers (J. Vorba and J. Křivánek,
/// Adjoint-driven Russian roulette and splitting in light transport simulation, 2016).
template <int N>
Float<N> guided_survival(const Floats3<N>& throughput, const Float<N>& brightness) {
  constexpr float kSurvival = 3, kLeast = 0.1F;
  const Float<N> plain = greatest_component(throughput);
  const Float<N> expected =
      larger_of(Float<N>(kSurvival * luminance(throughput) * brightness), Float<N>(kLeast * plain));
  return brightness < 0 ? plain : expected;
}

template <int N>
void finish_guided_from(float most_survival, ScatterLanes& lanes, int i) {
  using F = Float<N>;
  const F own = load<N>(lanes.pdf + i), part = load<N>(lanes.guide_part + i);
  const F mixed = own * (1 - part) + part * load<N>(lanes.guide_pdf + i);
  const Floats3<N> value = load3<N>(lanes.next_throughput, i);
  Floats3<N> next = value / mixed;
  auto survives = own > 0;
  if (most_survival < 1) {
    // Paths through glass are about to find light that other paths can't find.
    const F wanted = load<N>(lanes.is_smooth + i) != 0
                         ? all<N>(1)
                         : guided_survival<N>(value / own, load<N>(lanes.brightness + i));
    const F survival = smaller_of(wanted, all<N>(most_survival));
    survives = survives & (load<N>(lanes.chances[1] + i) < survival);
    next = next / survival;
  }
  store<N>(lanes.pdf + i, survives ? mixed : F{});
  store3<N>(lanes.next_throughput, i, next);
}

/// Sets the next throughputs and pdfs, and plays Russian roulette, after scatter().
template <int N>
void finish_guided(float most_survival, ScatterLanes& lanes) {
  for (int i = 0; i < kShadingLanes; i += N) finish_guided_from<N>(most_survival, lanes, i);
}

}  // namespace microtrace
