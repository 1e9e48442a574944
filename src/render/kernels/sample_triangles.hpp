#pragma once
/// Samples emissive triangles.

#include "render/lanes/light_lanes.hpp"
#include "render/lights/light_limits.hpp"
#include "render/sampling/warps.hpp"
#include "simd/transpose.hpp"

namespace microtrace {

/// N emissive triangles, one in each lane, and values at the sampled points.
template <int N>
struct SampledTriangles {
  Floats3<N> a, b, c, emission;
  Float<N> has_back, coverage;
  Unsigned<N> id;

  template <int width>
  SampledTriangles(const TriangleLight* triangles, const TriangleChoices<width>& choices, int i) {
    constexpr int kColumns = sizeof(TriangleLight) / sizeof(float);
    std::uint32_t indices[N];
    for (int k = 0; k < N; ++k) indices[k] = choices.triangle[i + k];
    Float<N> columns[kColumns];
    load_rows<N>(triangles->corners[0], indices, columns);
    a = {columns[0], columns[1], columns[2]};
    b = {columns[3], columns[4], columns[5]};
    c = {columns[6], columns[7], columns[8]};
    const auto is_textured = reinterpreted<Int<N>>(columns[14]) != 0;
    emission = select3(is_textured, load3<N>(choices.emission, i),
                       Floats3<N>{columns[9], columns[10], columns[11]});
    has_back = columns[12];
    id = reinterpreted<Unsigned<N>>(columns[13]);
    coverage = is_textured ? load<N>(choices.coverage + i) : all<N>(1);
  }
};

/// Sets the samples of the selected lanes.
template <int N, int width>
void sample_triangles_from(const TriangleLight* triangles, const TriangleChoices<width>& choices,
                           const LightChoices<width>& points, LightSamples<width>& samples, int i) {
  using F = Float<N>;
  using D = Double<N>;
  using V = Floats3<N>;
  using W = Doubles3<N>;
  const auto is_selected = load<N>(choices.selected + i) != 0;
  if (!any(is_selected)) return;
  const SampledTriangles<N> t(triangles, choices, i);
  const V weights =
      sampling::triangle_point<N>({load<N>(choices.u[0] + i), load<N>(choices.u[1] + i)});
  const V at = weights.x * t.a + weights.y * t.b + weights.z * t.c;
  const W from = to_double3<N>(t.a);
  const W cross_product = cross(W(to_double3<N>(t.b) - from), W(to_double3<N>(t.c) - from));
  const D length = square_root<N>(dot(cross_product, cross_product));
  const V normal = to_single3<N>(cross_product * (1 / length));
  const W to_light = to_double3<N>(at) - widened3<N>(points.p, i);
  const D square = dot(to_light, to_light), distance = square_root<N>(square);
  const V wi = to_single3<N>(to_light * (1 / distance));
  const F cosine = -dot(wi, normal);
  const D pdf = area_pdf<N>(square, length / 2, magnitude(cosine));

  const W light = to_double3<N>(t.emission) * (to_double<N>(t.coverage) / pdf);
  const SelectedLight<N> selected =
      selected_light<N>(to_light, distance, wi, light, pdf, widened<N>(points.probability + i));
  const auto is_finite = single_mask<N>((square > 0) & (square < __builtin_inf()));
  const auto faces = (cosine > 0) | ((cosine < 0) & (t.has_back != 0));
  const auto is_lit = is_selected & is_finite & faces & (t.coverage != 0) &
                      negated(is_zero(t.emission)) & (selected.pdf != 0);
  // Lanes that are not lit keep their samples.
  const auto put3 = [&](float(&to)[3][width], const V& v) {
    store3<N>(to, i, select3(is_lit, v, load3<N>(to, i)));
  };
  const auto put = [&](float(&to)[width], const F& x) {
    store<N>(to + i, is_lit ? x : load<N>(to + i));
  };
  put3(samples.wi, wi);
  put3(samples.to_light, selected.to_light);
  put(samples.is_far, selected.is_far);
  put3(samples.light, selected.light);
  put(samples.pdf, selected.pdf);
  const Unsigned<N> target = is_lit ? t.id : load_bits<N>(samples.target + i);
  __builtin_memcpy(samples.target + i, &target, sizeof target);
}

template <int N, int width>
void sample_triangles(const TriangleLight* triangles, const TriangleChoices<width>& choices,
                      const LightChoices<width>& points, LightSamples<width>& samples) {
  for (int i = 0; i < width; i += kDoubleLanes<N>)
    sample_triangles_from<kDoubleLanes<N>>(triangles, choices, points, samples, i);
}

}  // namespace microtrace
