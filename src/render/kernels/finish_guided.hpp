#pragma once
/// Finishes the sampling of directions by a mixture of BSDF and guide.

#include "render/kernels/survival.hpp"
#include "render/lanes/shading_kernels.hpp"

namespace microtrace {

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
                         : guided_survival_of<N>(value / own, load<N>(lanes.brightness + i));
    const F survival = limited_survival<N>(wanted, next, most_survival);
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
