#pragma once
/// Samples punctual lights (KHR_lights_punctual), for N lanes.

#include "render/lanes/light_lanes.hpp"
#include "render/lights/light_limits.hpp"

namespace microtrace {

/// The light that arrives at N points, without selection probabilities.
template <int N>
struct PunctualSamples {
  Doubles3<N> to_light;
  Double<N> distance;  ///< length of to_light
  Floats3<N> wi;       ///< unit direction to the light
  Doubles3<N> light;   ///< irradiance on a surface that faces the light
  Double<N> is_lit;    ///< 1 if light arrives, otherwise 0
};

/// The lights of N lanes, one component per member of PunctualLight.
template <int N>
struct PunctualLights {
  using D = Double<N>;
  using V = Doubles3<N>;

  V position, axis, color;
  D outer_cosine, penumbra, intensity, range, is_directional;

  /// get(i) returns the light of lane i.
  template <class Get>
  explicit PunctualLights(const Get& get) {
    for (int i = 0; i < N; ++i) {
      const PunctualLight& light = get(i);
      const auto put = [&](V& to, const double(&from)[3]) {
        set_lane(to.x, i, from[0]);
        set_lane(to.y, i, from[1]);
        set_lane(to.z, i, from[2]);
      };
      put(position, light.position);
      put(axis, light.axis);
      put(color, light.color);
      set_lane(outer_cosine, i, light.outer_cosine);
      set_lane(penumbra, i, light.penumbra);
      set_lane(intensity, i, light.intensity);
      set_lane(range, i, light.range);
      set_lane(is_directional, i, light.is_directional);
    }
  }

  /// The light at the points p.
  [[nodiscard]] PunctualSamples<N> at(const V& p) const {
    const D zero{}, one = zero + 1;
    const auto is_far = is_directional != 0;
    const V to_place = position - p;
    const D square = dot(to_place, to_place), distance = square_root<N>(square);
    const D cosine = -dot(to_place, axis) / distance;
    const D inside = clamped(D((cosine - outer_cosine) / penumbra), zero, one);
    // The falloff window decreases from 1 to 0 at the range.
    const D q = distance / range, window = clamped(D(1 - q * q * q * q), zero, one);
    const D arriving = intensity * inside * inside * window / square;
    const V to_light = select3(is_far, axis, to_place);
    const D irradiance = is_far ? intensity : arriving;
    const auto is_lit = is_far | ((square > 0) & (arriving > 0) & (distance < __builtin_inf()));
    const D length = square_root<N>(dot(to_light, to_light));
    return {to_light, length, to_single3<N>(select3(is_far, axis, to_place / distance)),
            irradiance * color, is_lit ? one : zero};
  }
};

/// Sets the samples of the selected lanes.
template <int N, int width>
void sample_punctual_from(const PunctualLight* lights, const PunctualChoices<width>& choices,
                          const LightChoices<width>& points, LightSamples<width>& samples, int i) {
  using F = Float<N>;
  using V = Floats3<N>;
  const PunctualLights<N> all_lights(
      [&](int k) -> const PunctualLight& { return lights[choices.light[i + k]]; });
  const PunctualSamples<N> found = all_lights.at(widened3<N>(points.p, i));
  const Double<N> probability =
      widened<N>(points.probability + i) / widened<N>(choices.group_size + i);
  const SelectedLight<N> selected = selected_light<N>(found.to_light, found.distance, found.wi,
                                                      found.light, Double<N>{}, probability);
  const auto is_lit = (load<N>(choices.selected + i) != 0) & (to_single<N>(found.is_lit) != 0);
  // Other lanes keep their samples.
  const auto put3 = [&](float(&to)[3][width], const V& v) {
    store3<N>(to, i, select3(is_lit, v, load3<N>(to, i)));
  };
  const auto put = [&](float(&to)[width], const F& x) {
    store<N>(to + i, is_lit ? x : load<N>(to + i));
  };
  put3(samples.wi, found.wi);
  put3(samples.to_light, selected.to_light);
  put(samples.is_far, larger_of(selected.is_far, to_single<N>(all_lights.is_directional)));
  put3(samples.light, selected.light);
  put(samples.pdf, F{});
}

template <int N, int width>
void sample_punctual(const PunctualLight* lights, const PunctualChoices<width>& choices,
                     const LightChoices<width>& points, LightSamples<width>& samples) {
  for (int i = 0; i < width; i += kDoubleLanes<N>)
    sample_punctual_from<kDoubleLanes<N>>(lights, choices, points, samples, i);
}

}  // namespace microtrace
