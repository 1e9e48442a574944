#pragma once
/// Fast float32 trigonometry for directions, with angles in revolutions. It uses only + - * /, each
/// rounded once, so the bits are the same on every machine. The polynomials are Chebyshev
/// interpolants.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace microtrace {

/// Returns condition ? a : b without a branch, for unpredictable conditions.
[[nodiscard]] inline float chosen(bool condition, float a, float b) {
  const std::uint32_t mask = 0U - std::uint32_t{condition};
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(a) & mask) |
                              (std::bit_cast<std::uint32_t>(b) & ~mask));
}

/// The angle between the vector (x, y) and the x axis, in [-1/2, 1/2] revolutions; 0 for (0, 0).
/// The error is at most 1e-7. Inputs must be finite.
[[nodiscard]] inline float atan2_revolutions(float y, float x) {
  const float ax = std::abs(x), ay = std::abs(y);
  // If both inputs are below the least normal number, the angle is inaccurate. The minimum also
  // avoids a division by 0.
  const float t = std::min(ax, ay) / std::max({ax, ay, std::numeric_limits<float>::min()});
  const float z = t * t, z2 = z * z, z4 = z2 * z2;
  // Evaluates atan(t) / (2 pi t) for z = t^2 in [0, 1] by Estrin's scheme, with an error of 3e-9.
  const float low = (0.15915494F - 0.053051222F * z) + (0.031819027F - 0.022604093F * z) * z2;
  const float high = (0.01692892F - 0.011929372F * z) + (0.006778028F - 0.0025472797F * z) * z2;
  const float eighth = t * (low + (high + 0.00045105536F * z4) * z4);
  const float quarter = chosen(ay > ax, 0.25F - eighth, eighth);
  return std::copysign(chosen(x < 0, 0.5F - quarter, quarter), y);
}

struct SineCosine {
  float sine, cosine;
};

/// Sine and cosine of an angle in [0, 1] revolutions. The error is at most 2^-23.
[[nodiscard]] inline SineCosine sin_cos_revolutions(float revolutions) {
  const float quarters = 4 * revolutions;
  // `quarters` is not negative, and ties may round either way.
  // NOLINTNEXTLINE(bugprone-incorrect-roundings)
  const int quadrant = static_cast<int>(quarters + 0.5F);
  const float f = quarters - static_cast<float>(quadrant), z = f * f;  // f in [-1/2, 1/2], exact
  const float s = f * ((1.5707964F - 0.6459635F * z) + (0.07968022F - 0.004602163F * z) * (z * z));
  const float c =
      (1 - 1.2337005F * z) + ((0.2536692F - 0.02086007F * z) + 0.00090362987F * (z * z)) * (z * z);
  const bool is_swapped = (quadrant & 1) != 0;
  const float sine = chosen(is_swapped, c, s), cosine = chosen(is_swapped, s, c);
  return {.sine = chosen((quadrant & 2) != 0, -sine, sine),
          .cosine = chosen(((quadrant + 1) & 2) != 0, -cosine, cosine)};
}

}  // namespace microtrace
