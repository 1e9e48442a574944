#pragma once
/// Selects lights by their importance at points.

#include "render/kernels/light_lanes.hpp"
#include "render/lights/light_node.hpp"
#include "render/sampling/warps.hpp"

namespace microtrace {

/// The probabilities of selecting the environment, far lights, and near lights at N points.
template <int N>
struct KindProbabilities {
  Float<N> environment, far, near;
};

/// Computes probabilities of the kinds of light in proportion to their estimated contributions,
/// with a minimum probability. A uniform environment has a probability too, although it isn't
/// sampled: this spends fewer samples on other lights where they contribute little. Its estimate is
/// reduced, because little of its light may arrive indoors. `share` is the factor of
/// environment_light.
template <int N>
KindProbabilities<N> kind_probabilities(const LightChoiceSetup& setup, const Doubles3<N>& p,
                                        const Floats3<N>& n, const Double<N>& share) {
  using F = Float<N>;
  using D = Double<N>;
  constexpr float kLeast = 0.1F;
  D near{};
  if (setup.nodes != nullptr) near = LightNodes<N>(*setup.nodes).importance(p, n);
  const D sky = setup.environment_light * share;
  const D sum = sky + setup.far_light + near;
  const auto part = [&](bool is_there, const D& light) {
    if (!is_there) return F{};
    return larger_of(to_single<N>(sum > 0 ? light / sum : D{}), all<N>(kLeast));
  };
  const F environment = part(setup.environment_light > 0, sky);
  const F far = part(setup.has_far, D{} + setup.far_light);
  const F of_near = part(setup.nodes != nullptr, near);
  const F all_kinds = environment + far + of_near;
  const auto is_lit = all_kinds != 0;
  return {is_lit ? environment / all_kinds : F{}, is_lit ? far / all_kinds : F{},
          is_lit ? of_near / all_kinds : F{}};
}

template <int N, int width>
void choose_lights_from(const LightChoiceSetup& setup, LightChoices<width>& lanes, int i) {
  using F = Float<N>;
  const Doubles3<N> p = widened3<N>(lanes.p, i);
  const Floats3<N> n = load3<N>(lanes.n, i);
  const KindProbabilities<N> kinds =
      kind_probabilities<N>(setup, p, n, widened<N>(lanes.share + i));
  const F choice = load<N>(lanes.choice + i), beyond = choice - kinds.environment;
  const F of_near = sampling::reused<N>(beyond, kinds.far, kinds.near);
  const auto is_environment = choice < kinds.environment;
  const auto is_far = (kinds.near == 0) | (beyond < kinds.far);
  const auto is_near = negated(is_environment) & negated(is_far);
  LightChoice<N> chosen{};
  if (setup.nodes != nullptr && any(is_near))
    chosen = choose_light<N>(setup.nodes, p, n, is_near ? of_near : F{});
  const F reused = is_environment ? choice : is_far ? beyond / kinds.far : of_near;
  store<N>(lanes.choice + i, reused);
  for (int k = 0; k < N; ++k) {
    double probability = lane(kinds.environment, k);
    LightKind kind = LightKind::environment;
    if (lane(is_environment, k) == 0) {
      const bool takes_near = lane(is_near, k) != 0;
      kind = takes_near ? LightKind::near : LightKind::far;
      probability = lane(takes_near ? kinds.near : kinds.far, k);
      if (takes_near) probability *= lane(chosen.probability, k);
    }
    lanes.kind[i + k] = probability > 0 ? kind : LightKind::none;
    lanes.probability[i + k] = probability;
    lanes.light[i + k] = chosen.light[k];
  }
}

/// Selects lights for all points. Processes as many points at a time as a vector has float64 lanes.
template <int N, int width>
void choose_lights(const LightChoiceSetup& setup, LightChoices<width>& lanes) {
  for (int i = 0; i < width; i += kDoubleLanes<N>)
    choose_lights_from<kDoubleLanes<N>>(setup, lanes, i);
}

}  // namespace microtrace
