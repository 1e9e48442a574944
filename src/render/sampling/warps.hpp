#pragma once
/// Warps from two random numbers to directions, in float32 with + - * / and sqrt only.

#include <microtrace/math.hpp>

#include <algorithm>
#include <cmath>

namespace microtrace::sampling {

/// Rescales u, after it has selected the interval [begin, begin + share), to [0, 1) for reuse. The
/// result is in range despite rounding.
inline float reused(float u, float begin, float share) {
  return std::min((u - begin) / share, 0x1.fffffep-1F);
}

/// Cosine and sine of an angle.
struct UnitPair {
  float cosine, sine;
};

/// Cosine and sine of u revolutions, u in [0, 1]. Errors are below 2^-22.
inline UnitPair unit_pair(float u) {
  // Not negative, and ties may go either way. NOLINTNEXTLINE(bugprone-incorrect-roundings)
  const auto quarter = static_cast<float>(static_cast<int>(4 * u + 0.5F));
  const float x = (u - quarter * 0.25F) * 6.28318530717958648F;  // in [-pi/4, pi/4]
  const float z = x * x;
  // Taylor polynomials; the first omitted term is below 2^-23.
  const float s = x + x * z * (-1 / 6.0F + z * (1 / 120.0F - z * (1 / 5040.0F)));
  const float c = 1 - z * (0.5F - z * (1 / 24.0F - z * (1 / 720.0F - z * (1 / 40320.0F))));
  const bool swaps = (static_cast<int>(quarter) & 1) != 0;
  const bool second_half = (static_cast<int>(quarter) & 2) != 0;
  const float cosine = swaps ? -s : c, sine = swaps ? c : s;
  return second_half ? UnitPair{-cosine, -sine} : UnitPair{cosine, sine};
}

/// Around +z, with the pdf cos(theta) / pi.
inline Vec3 cosine_hemisphere(const Vec2& u) {
  const auto [cosine, sine] = unit_pair(u.x);
  const float r = std::sqrt(u.y);
  return {r * cosine, r * sine, std::sqrt(1 - u.y)};
}

/// The weights of a triangle's first two vertices, uniform over its area (E. Heitz, A
/// low-distortion map between triangle and square, 2019).
inline Vec2 triangle_weights(const Vec2& u) {
  if (u.y > u.x) return {u.x * 0.5F, u.y - u.x * 0.5F};
  return {u.x - u.y * 0.5F, u.y * 0.5F};
}

}  // namespace microtrace::sampling
