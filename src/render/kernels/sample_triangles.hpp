#pragma once
/// Samples emissive triangles.

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
  const V weights = sampling::triangle_point<N>({load<N>(lanes.u[0] + i), load<N>(lanes.u[1] + i)});
  const V a = load3<N>(lanes.corners[0], i), b = load3<N>(lanes.corners[1], i),
          c = load3<N>(lanes.corners[2], i);
  const V at = weights.x * a + weights.y * b + weights.z * c;
  const W from = to_double3<N>(a);
  const W cross_product = cross(W(to_double3<N>(b) - from), W(to_double3<N>(c) - from));
  const D length = square_root<N>(dot(cross_product, cross_product));
  const V normal = to_single3<N>(cross_product / length);
  const W to_light = to_double3<N>(at) - widened3<N>(lanes.p, i);
  const D square = dot(to_light, to_light), distance = square_root<N>(square);
  const V wi = to_single3<N>(to_light / distance);
  const F cosine = -dot(wi, normal);
  const D pdf = area_pdf<N>(square, length / 2, magnitude(cosine));

  const V emission = load3<N>(lanes.emission, i);
  const F coverage = load<N>(lanes.coverage + i);
  const W light = to_double3<N>(emission) * (to_double<N>(coverage) / pdf);
  const SelectedLight<N> selected =
      selected_light<N>(to_light, distance, wi, light, pdf, load_doubles<N>(lanes.probability + i));
  const auto is_finite = single_mask<N>((square > 0) & (square < __builtin_inf()));
  const auto faces = (cosine > 0) | ((cosine < 0) & (load<N>(lanes.has_back + i) != 0));
  const auto is_lit = is_finite & faces & (coverage != 0) & negated(is_zero(emission));
  store3<N>(lanes.wi, i, wi);
  store3<N>(lanes.to_light, i, selected.to_light);
  store<N>(lanes.is_far + i, selected.is_far);
  store3<N>(lanes.light, i, selected.light);
  store<N>(lanes.pdf + i, is_lit ? selected.pdf : F{});
}

template <int N, int width>
void sample_triangles(TriangleLights<width>& lanes) {
  for (int i = 0; i < width; i += kDoubleLanes<N>) sample_triangles_from<kDoubleLanes<N>>(lanes, i);
}

}  // namespace microtrace
