#pragma once
/// Fast float32 trigonometry for directions, with angles in revolutions. The bits are the same on
/// every machine.

#include "simd/revolutions.hpp"

namespace microtrace {

/// The angle between the vector (x, y) and the x axis, in [-1/2, 1/2] revolutions; 0 for (0, 0).
/// The error is at most 1e-7. Inputs must be finite.
[[nodiscard]] inline float atan2_revolutions(float y, float x) {
  return atan2_revolutions<1>(y, x);
}

using SineCosine = SineCosineLanes<1>;

/// Sine and cosine of an angle in [0, 1] revolutions. The error is at most 2^-23.
[[nodiscard]] inline SineCosine sin_cos_revolutions(float revolutions) {
  return sin_cos_revolutions<1>(revolutions);
}

}  // namespace microtrace
