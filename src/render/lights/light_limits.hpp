#pragma once
/// Limits that keep products of lights representable in float32, for N lanes.

#include "render/luminance.hpp"
#include "simd/vector3.hpp"

namespace microtrace {

/// The distances from a light whose vector is representable in float32, with all its digits.
inline constexpr double kLeastReach = 0x1p-126, kGreatestReach = 0x1.fffffep127;

/// The pdf clamped to numbers whose square is representable in float32.
template <int N>
Double<N> limited_pdf(const Double<N>& pdf) {
  constexpr double kMost = 0x1p60;
  const Double<N> zero{};
  return pdf < kMost ? larger_of(pdf, zero + 1 / kMost) : zero + kMost;
}

}  // namespace microtrace
