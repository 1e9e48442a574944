#pragma once
/// Selects lights by their importance at points.

#include "render/lanes/light_lanes.hpp"
#include "render/lights/light_importance.hpp"
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
/// reduced, because little of its light may arrive indoors. p is in the units of the lights' tree,
/// and `share` is the factor of environment_light.
template <int N>
KindProbabilities<N> kind_probabilities(const LightChoiceSetup& setup, const Floats3<N>& p,
                                        const Floats3<N>& n, const Float<N>& share) {
  using F = Float<N>;
  constexpr float kLeast = 0.1F;
  // The only kind has the probability 1, however small its estimate is.
  if (!setup.has_far && !(setup.environment_light > 0))
    return {F{}, F{}, setup.nodes != nullptr ? all<N>(1) : F{}};
  F near{};
  if (setup.nodes != nullptr) near = LightNodes<N>(*setup.nodes).importance(p, n);
  const F sky = setup.environment_light * share;
  const F sum = sky + setup.far_light + near;
  const auto part = [&](bool is_there, const F& light) {
    if (!is_there) return F{};
    return larger_of(sum > 0 ? F(light / sum) : F{}, all<N>(kLeast));
  };
  const F environment = part(setup.environment_light > 0, sky);
  const F far = part(setup.has_far, all<N>(setup.far_light));
  const F of_near = part(setup.nodes != nullptr, near);
  const F all_kinds = environment + far + of_near;
  const auto is_lit = all_kinds != 0;
  return {is_lit ? environment / all_kinds : F{}, is_lit ? far / all_kinds : F{},
          is_lit ? of_near / all_kinds : F{}};
}

template <int N, int width>
void choose_lights_from(const LightChoiceSetup& setup, LightChoices<width>& lanes, int i) {
  using F = Float<N>;
  const Floats3<N> p = in_tree_units<N>(setup.space, load3<N>(lanes.p, i)),
                   n = load3<N>(lanes.n, i);
  const KindProbabilities<N> kinds = kind_probabilities<N>(setup, p, n, load<N>(lanes.share + i));
  const F choice = load<N>(lanes.choice + i), beyond = choice - kinds.environment;
  const F of_near = sampling::reused<N>(beyond, kinds.far, kinds.near);
  const auto is_environment = choice < kinds.environment;
  const auto is_far = (kinds.near == 0) | (beyond < kinds.far);
  const auto is_near = negated(is_environment) & negated(is_far);
  const Lanes near = true_lanes<N>(is_near);
  LightChoice<N> chosen{};
  if (near != 0) chosen = choose_light<N>(setup.nodes, p, n, of_near, near);
  store<N>(lanes.choice + i, is_environment ? choice : is_far ? beyond / kinds.far : of_near);
  const F probability = is_environment ? kinds.environment
                        : is_near      ? kinds.near * chosen.probability
                                       : kinds.far;
  store<N>(lanes.probability + i, probability);
  const auto kind = [](LightKind value) { return Int<N>{} + static_cast<std::int32_t>(value); };
  Int<N> kind_of = is_environment ? kind(LightKind::environment)
                   : is_near      ? kind(LightKind::near)
                                  : kind(LightKind::far);
  kind_of = probability > 0 ? kind_of : kind(LightKind::none);
  __builtin_memcpy(lanes.kind + i, &kind_of, sizeof kind_of);
  __builtin_memcpy(lanes.light + i, chosen.light, sizeof chosen.light);
}

/// Sets the probabilities with which choose_lights() selects the environment.
template <int N, int width>
void environment_probabilities(const LightChoiceSetup& setup, LightChoices<width>& lanes) {
  for (int i = 0; i < width; i += N) {
    const Floats3<N> p = in_tree_units<N>(setup.space, load3<N>(lanes.p, i)),
                     n = load3<N>(lanes.n, i);
    store<N>(lanes.probability + i,
             kind_probabilities<N>(setup, p, n, load<N>(lanes.share + i)).environment);
  }
}

/// Selects lights for all points.
template <int N, int width>
void choose_lights(const LightChoiceSetup& setup, LightChoices<width>& lanes) {
  for (int i = 0; i < width; i += N) choose_lights_from<N>(setup, lanes, i);
}

}  // namespace microtrace
