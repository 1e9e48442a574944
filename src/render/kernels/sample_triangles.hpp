#pragma once
/// Samples of emissive triangles.

#include "render/kernels/find_points.hpp"
#include "render/kernels/light_lanes.hpp"
#include "render/lights/light_limits.hpp"
#include "render/sampling/warps.hpp"

namespace microtrace {

template <int N, int width>
void sample_triangles_from(TriangleLights<width>& lanes, int i) {
  using F = Float<N>;
  using D = Double<N>;
  using V = Floats3<N>;
  using W = Doubles3<N>;
  const auto narrow = [](const W& v) {
    return V{to_single<N>(v.x), to_single<N>(v.y), to_single<N>(v.z)};
  };
  const D zero{}, one = zero + 1;
  const Floats2<N> pair =
      sampling::triangle_weights<N>({load<N>(lanes.u[0] + i), load<N>(lanes.u[1] + i)});
  const V weights{pair.x, pair.y, larger_of(F(1 - pair.x - pair.y), F{})};
  const V a = load3<N>(lanes.corners[0], i), b = load3<N>(lanes.corners[1], i),
          c = load3<N>(lanes.corners[2], i);
  const V at = weights.x * a + weights.y * b + weights.z * c, p = load3<N>(lanes.p, i);
  const auto widen = [](const V& v) {
    return W{to_double<N>(v.x), to_double<N>(v.y), to_double<N>(v.z)};
  };
  const W cross_product = cross(W(widen(b) - widen(a)), W(widen(c) - widen(a)));
  const D length = square_root<N>(dot(cross_product, cross_product));
  const V normal = narrow(cross_product / length);
  const W to_light = widen(at) - widen(p);
  const D square = dot(to_light, to_light), distance = square_root<N>(square);
  const V wi = narrow(to_light / distance);
  const F cosine = -dot(wi, normal);
  const D pdf = square / (length / 2 * to_double<N>(magnitude(cosine)));
  const D probability = load_doubles<N>(lanes.probability + i);

  const V emission = load3<N>(lanes.emission, i);
  const D share = to_double<N>(load<N>(lanes.coverage + i)) / pdf;
  const W light = widen(emission) * share / probability;
  const auto limited = [&](const D& x) {
    return to_single<N>(smaller_of(x, zero + double{kBrightest}));
  };
  store3<N>(lanes.light, i, V{limited(light.x), limited(light.y), limited(light.z)});

  // Shadow rays need a direction that is representable in float32.
  const auto has_direction =
      to_single<N>((distance >= kLeastReach) & (distance <= kGreatestReach) ? one : zero) != 0;
  store<N>(lanes.is_far + i, has_direction ? F{} : all<N>(1));
  store3<N>(lanes.to_light, i, select3(has_direction, narrow(to_light), wi));
  store3<N>(lanes.wi, i, wi);

  const auto is_finite = to_single<N>((square > 0) & (square < __builtin_inf()) ? one : zero) != 0;
  const auto faces = (cosine > 0) | ((cosine < 0) & (load<N>(lanes.has_back + i) != 0));
  const auto is_lit =
      is_finite & faces & (load<N>(lanes.coverage + i) != 0) & negated(is_zero(emission));
  store<N>(lanes.pdf + i, is_lit ? to_single<N>(limited_pdf<N>(pdf * probability)) : F{});
}

template <int N, int width>
void sample_triangles(TriangleLights<width>& lanes) {
  for (int i = 0; i < width; i += kDoubleLanes<N>) sample_triangles_from<kDoubleLanes<N>>(lanes, i);
}

}  // namespace microtrace
