#pragma once
/// Samples environments, for N lanes.

#include "render/guiding/guide_table.hpp"
#include "render/lanes/environment_lanes.hpp"
#include "render/lanes/light_lanes.hpp"
#include "simd/revolutions.hpp"

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// Sets how the environment is sampled at the first `count` points. A uniform environment is
/// sampled only by visibility.
template <int N, int width>
void split_environment(const LightChoices<width>& choices, int count,
                       EnvironmentSamples<width>& samples) {
  using F = Float<N>;
  const F zero{}, one = all<N>(1);
  Lanes selected_lanes = 0, visible_lanes = 0;
  for (int i = 0; i < width; i += N) {
    const F part = load<N>(samples.cells.part + i);
    Int<N> kind;
    __builtin_memcpy(&kind, choices.kind + i, sizeof kind);
    auto is_selected = kind == static_cast<std::int32_t>(LightKind::environment);
    if (samples.cells.is_uniform) is_selected = is_selected & (part > 0);
    // The kernel choose_lights() selects the environment with the lowest numbers.
    const F choice = load<N>(choices.choice + i) / load<N>(choices.probability + i);
    const auto is_visible = is_selected & (choice < part);
    store<N>(samples.is_selected + i, is_selected ? one : zero);
    store<N>(samples.by_visibility + i, is_visible ? one : zero);
    selected_lanes |= true_lanes<N>(is_selected) << i;
    visible_lanes |= true_lanes<N>(is_visible) << i;
  }
  const Lanes known = (Lanes{1} << count) - 1;
  samples.lanes_by_visibility = visible_lanes & known;
  samples.lanes_independent = selected_lanes & ~visible_lanes & known;
}

/// Samples uniform directions d for u in [0, 1)^2.
template <int N, int width>
void sample_sphere(const float (&u)[2][width], float (&d)[3][width]) {
  using F = Float<N>;
  for (int i = 0; i < width; i += N) {
    const F h = load<N>(u[1] + i), r = 2 * square_root<N>(h * (1 - h));
    const auto angle = sin_cos_revolutions<N>(load<N>(u[0] + i));
    store3<N>(d, i, {r * angle.cosine, 1 - 2 * h, r * angle.sine});
  }
}

/// Returns the pdfs of the directions in cells.guides.wi in the mixtures of visibility and the
/// environment's own distribution. `own` are the pdfs in the latter.
template <int N, int width>
Float<N> mixed_pdf(EnvironmentCells<width>& cells, const Float<N>& own, int i) {
  const Float<N> part = load<N>(cells.part + i);
  const Float<N> otherwise = cells.is_uniform ? Float<N>{} : own;
  if (!cells.is_any) return otherwise;
  guide_pdfs_from<N>(cells.guides, i);
  return part > 0 ? part * load<N>(cells.guides.pdf + i) + (1 - part) * own : otherwise;
}

/// Changes the pdfs of directions from those in the environment's own distribution to those in the
/// mixtures.
template <int N, int width>
void mix_environment_pdfs(const float (&wi)[3][width], EnvironmentCells<width>& cells,
                          float (&pdfs)[width]) {
  for (int i = 0; i < width; i += N) {
    store3<N>(cells.guides.wi, i, load3<N>(wi, i));
    store<N>(pdfs + i, mixed_pdf<N>(cells, load<N>(pdfs + i), i));
  }
}

/// Sets the light samples where the environment is sampled.
template <int N, int width>
void finish_environment(const LightChoices<width>& choices, EnvironmentSamples<width>& from,
                        LightSamples<width>& samples) {
  using F = Float<N>;
  using V = Floats3<N>;
  for (int i = 0; i < width; i += N) {
    const auto is_selected = load<N>(from.is_selected + i) != 0;
    const auto is_visible = load<N>(from.by_visibility + i) != 0;
    GuideLanes<width>& guides = from.cells.guides;
    const V wi = select3(is_visible, load3<N>(guides.wi, i), load3<N>(from.independent.d, i));
    const V radiance = select3(is_visible, load3<N>(from.visible.radiance, i),
                               load3<N>(from.independent.radiance, i));
    const F own = is_visible ? load<N>(from.visible.pdf + i) : load<N>(from.independent.pdf + i);
    store3<N>(guides.wi, i, wi);
    const F pdf = mixed_pdf<N>(from.cells, own, i) * load<N>(choices.probability + i);
    const auto put = [&](float* to, const F& x) {
      store<N>(to + i, is_selected ? x : load<N>(to + i));
    };
    const auto put3 = [&](float(&to)[3][width], const V& v) {
      put(to[0], v.x);
      put(to[1], v.y);
      put(to[2], v.z);
    };
    put3(samples.to_light, wi);
    put3(samples.wi, wi);
    put(samples.is_far, all<N>(1));
    put3(samples.light, radiance / pdf);
    put(samples.pdf, pdf);
  }
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
