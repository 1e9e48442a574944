#pragma once
/// Limits that keep products of light parameters representable in float32, for N lanes.

#include "scene/math/luminance.hpp"
#include "simd/vector3.hpp"

namespace microtrace {

/// Limits of the distance to a light. Within them, float32 represents the vector to the light with
/// full precision.
inline constexpr double kLeastReach = 0x1p-126, kGreatestReach = 0x1.fffffep127;

/// Clamps a pdf to the numbers whose squares float32 can represent.
template <int N>
Double<N> limited_pdf(const Double<N>& pdf) {
  constexpr double kMost = 0x1p60;
  const Double<N> zero{};
  return pdf < kMost ? larger_of(pdf, zero + 1 / kMost) : zero + kMost;
}

/// The pdf, per solid angle, of the direction to a point that is uniformly distributed over an
/// area. `square` is the squared distance. `cosine` is the cosine of the angle between the
/// direction and the surface normal; it must be positive.
template <int N>
Double<N> area_pdf(const Double<N>& square, const Double<N>& area, const Float<N>& cosine) {
  return square / (area * to_double<N>(cosine));
}

/// A sample of a light that was selected with some probability, in the form needed for shadow rays.
template <int N>
struct SelectedLight {
  Floats3<N> to_light;
  Float<N> is_far;  ///< 1 if to_light is only a direction, otherwise 0
  Floats3<N> light;
  Float<N> pdf;
};

/// Combines a sample with the probability of selecting its light. `light` and `pdf` must not
/// contain this probability. `distance` must be the length of to_light. A pdf of 0 remains 0.
template <int N>
SelectedLight<N> selected_light(const Doubles3<N>& to_light, const Double<N>& distance,
                                const Floats3<N>& wi, const Doubles3<N>& light,
                                const Double<N>& pdf, const Double<N>& probability) {
  // If float32 can't represent the direction, there is no shadow ray.
  const auto has_direction =
      single_mask<N>((distance >= kLeastReach) & (distance <= kGreatestReach));
  const Double<N> most = Double<N>{} + double{kBrightest};
  const Doubles3<N> limited =
      least_components(Doubles3<N>(light * (1 / probability)), Doubles3<N>{most, most, most});
  const Double<N> selected_pdf = pdf > 0 ? limited_pdf<N>(pdf * probability) : Double<N>{};
  return {select3(has_direction, to_single3<N>(to_light), wi),
          has_direction ? Float<N>{} : all<N>(1), to_single3<N>(limited),
          to_single<N>(selected_pdf)};
}

}  // namespace microtrace
