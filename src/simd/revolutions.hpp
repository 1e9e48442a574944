#pragma once
/// Fast float32 trigonometry for directions, with angles in revolutions, for N lanes. It uses only
/// + - * /, each rounded once, so the bits are the same on every machine. The polynomials are
/// Chebyshev interpolants.

#include "simd/vector3.hpp"

#include <limits>

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// The angle between the vector (x, y) and the x axis, in [-1/2, 1/2] revolutions; 0 for (0, 0).
/// The error is at most 1e-7. Inputs must be finite.
template <int N>
Float<N> atan2_revolutions(const Float<N>& y, const Float<N>& x) {
  using F = Float<N>;
  const F ax = magnitude(x), ay = magnitude(y);
  // If both inputs are below the least normal number, the angle is inaccurate. The minimum also
  // avoids a division by 0.
  const F least = all<N>(std::numeric_limits<float>::min());
  const F t = smaller_of(ax, ay) / larger_of(larger_of(ax, ay), least);
  const F z = t * t, z2 = z * z, z4 = z2 * z2;
  // Evaluates atan(t) / (2 pi t) for z = t^2 in [0, 1] by Estrin's scheme, with an error of 3e-9.
  const F low = (0.15915494F - 0.053051222F * z) + (0.031819027F - 0.022604093F * z) * z2;
  const F high = (0.01692892F - 0.011929372F * z) + (0.006778028F - 0.0025472797F * z) * z2;
  const F eighth = t * (low + (high + 0.00045105536F * z4) * z4);
  const F quarter = chosen<N>(ay > ax, 0.25F - eighth, eighth);
  return with_sign_of<N>(chosen<N>(x < 0, 0.5F - quarter, quarter), y);
}

template <int N>
struct SineCosineLanes {
  Float<N> sine, cosine;
};

/// Sine and cosine of an angle in [0, 1] revolutions. The error is at most 2^-23.
template <int N>
SineCosineLanes<N> sin_cos_revolutions(const Float<N>& revolutions) {
  using F = Float<N>;
  const F quarters = 4 * revolutions;
  // `quarters` is not negative, and ties may round either way.
  const Int<N> quadrant = truncated<N>(F(quarters + 0.5F));
  const F f = quarters - to_float<N>(quadrant), z = f * f;  // f in [-1/2, 1/2], exact
  const F s = f * ((1.5707964F - 0.6459635F * z) + (0.07968022F - 0.004602163F * z) * (z * z));
  const F c =
      (1 - 1.2337005F * z) + ((0.2536692F - 0.02086007F * z) + 0.00090362987F * (z * z)) * (z * z);
  const auto is_swapped = (quadrant & 1) != 0;
  const F sine = chosen<N>(is_swapped, c, s), cosine = chosen<N>(is_swapped, s, c);
  return {chosen<N>((quadrant & 2) != 0, -sine, sine),
          chosen<N>(((quadrant + 1) & 2) != 0, -cosine, cosine)};
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
