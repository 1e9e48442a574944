#pragma once
/// Direct light, and sampling of the next direction.

#include "render/kernels/bsdf_lanes.hpp"
#include "render/kernels/kernel.hpp"
#include "render/kernels/sobol_lanes.hpp"
#include "render/kernels/vector3.hpp"

namespace microtrace {
namespace {

template <int N>
inline Float<N> power_heuristic(const Float<N>& pdf, const Float<N>& other) {
  const Float<N> square = pdf * pdf;
  return square / (square + other * other);
}

/// The contribution of the light sample.
template <int N>
inline void light(const BsdfLanes<N>& bsdf, const FrameLanes<N>& frame, const Vector3<Float<N>>& wo,
                  ScatterLanes& lanes, int i) {
  using F = Float<N>;
  const auto wi_world = load3<N>(lanes.light_wi, i), wi = frame.to_local(wi_world);
  const F pdf = load<N>(lanes.light_pdf + i), one = all<N>(1);
  const auto f = bsdf.above(wi, unit<N>(wo + wi));
  const F weight = pdf > 0 ? power_heuristic<N>(pdf, f.pdf) : one;
  const auto color = weight * (load3<N>(lanes.throughput, i) * f.value * load3<N>(lanes.light, i));
  const auto reaches = (wi.z > 0) & (dot(wi_world, load3<N>(lanes.outwards, i)) > 0);
  store3<N>(lanes.shadow, i, select3(reaches, color, Vector3<F>{}));
}

template <int N>
inline void go_on(const ScatterSetup& setup, const BsdfLanes<N>& bsdf, const FrameLanes<N>& frame,
                  ScatterLanes& lanes, int i) {
  using F = Float<N>;
  const SobolLanes<N> sobol(lanes.key + i, lanes.index + i);
  const auto u = sobol.pair(setup.direction_pair), chances = sobol.pair(setup.lobe_pair);
  const auto direction = bsdf.sample(u.x, u.y, chances.x);
  const auto e = bsdf.above(direction.wi, direction.h);
  const auto wi = frame.to_world(direction.wi);
  auto next = load3<N>(lanes.throughput, i) * (e.value / e.pdf);
  auto survives = (direction.wi.z > 0) & (e.pdf > 0) & (dot(wi, load3<N>(lanes.outwards, i)) > 0);
  if (setup.most_survival < 1) {
    const F survival =
        smaller_of(larger_of(larger_of(next.x, next.y), next.z), all<N>(setup.most_survival));
    survives &= chances.y < survival;
    next = next / survival;
  }
  store3<N>(lanes.wi, i, wi);
  store3<N>(lanes.next_throughput, i, next);
  store<N>(lanes.pdf + i, survives ? e.pdf : F{});
}

template <int N>
void scatter(const ScatterSetup& setup, ScatterLanes& lanes) {
  for (int i = 0; i < kShadingLanes; i += N) {
    const FrameLanes<N> frame(load3<N>(lanes.frame_n, i));
    auto wo = frame.to_local(-unit<N>(load3<N>(lanes.d, i)));
    wo.z = larger_of(wo.z, all<N>(1e-5F));
    const BsdfLanes<N> bsdf(setup, lanes, i, wo);
    light<N>(bsdf, frame, wo, lanes, i);
    go_on<N>(setup, bsdf, frame, lanes, i);
  }
}

}  // namespace
}  // namespace microtrace
