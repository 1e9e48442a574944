#pragma once
/// Limits that keep products of light parameters representable in float32, for N lanes.

#include "render/luminance.hpp"
#include "simd/vector3.hpp"

namespace microtrace {

/// Limits of the distance to a light, so that the vector to it is representable in float32 without
/// loss of digits.
inline constexpr double kLeastReach = 0x1p-126, kGreatestReach = 0x1.fffffep127;

/// Clamps the pdf to numbers whose square is representable in float32.
template <int N>
Double<N> limited_pdf(const Double<N>& pdf) {
  constexpr double kMost = 0x1p60;
  const Double<N> zero{};
  return pdf < kMost ? larger_of(pdf, zero + 1 / kMost) : zero + kMost;
}

/// The pdf per solid angle of a point that is uniformly distributed over an area, as seen from a
/// distance with this square. `cosine`, above 0, is that of the angle between the direction and the
/// surface normal.
template <int N>
Double<N> area_pdf(const Double<N>& square, const Double<N>& area, const Float<N>& cosine) {
  return square / (area * to_double<N>(cosine));
}

/// A light selected with some probability, in the form that shadow rays need.
template <int N>
struct SelectedLight {
  Floats3<N> to_light;
  Float<N> is_far;  ///< 1 if to_light is only a direction, else 0
  Floats3<N> light;
  Float<N> pdf;
};

/// `light` and `pdf` are without the selection probability; `distance` is the length of to_light. A
/// pdf of 0 stays 0.
template <int N>
SelectedLight<N> selected_light(const Doubles3<N>& to_light, const Double<N>& distance,
                                const Floats3<N>& wi, const Doubles3<N>& light,
                                const Double<N>& pdf, const Double<N>& probability) {
  // Without a direction that is representable in float32 there is no shadow ray.
  const auto has_direction =
      single_mask<N>((distance >= kLeastReach) & (distance <= kGreatestReach));
  const Double<N> most = Double<N>{} + double{kBrightest};
  const Doubles3<N> limited =
      least_components(Doubles3<N>(light / probability), Doubles3<N>{most, most, most});
  const Double<N> selected_pdf = pdf > 0 ? limited_pdf<N>(pdf * probability) : Double<N>{};
  return {select3(has_direction, to_single3<N>(to_light), wi),
          has_direction ? Float<N>{} : all<N>(1), to_single3<N>(limited),
          to_single<N>(selected_pdf)};
}

}  // namespace microtrace
