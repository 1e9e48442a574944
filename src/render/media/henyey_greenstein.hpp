#pragma once
/// The phase function of L. Henyey and J. Greenstein (Diffuse radiation in the galaxy, 1941). g in
/// (-1, 1) is the mean cosine of the scattering angle: positive values scatter forward.

#include <cmath>
#include <numbers>

namespace microtrace {

/// The pdf per solid angle of scattering by an angle with this cosine.
[[nodiscard]] inline double henyey_greenstein_pdf(double g, double cosine) {
  const double base = 1 + g * g - 2 * g * cosine;
  return (1 - g * g) / (4 * std::numbers::pi * base * std::sqrt(base));
}

/// The cosine of a scattering angle, from a random number u in [0, 1). With m = 2 u - 1, this is
///
///     (1 + g^2 - ((1 - g^2) / (1 + g m))^2) / (2 g),
///
/// expanded so that no terms cancel for small g, and g = 0 needs no case of its own.
[[nodiscard]] inline double henyey_greenstein_cosine(double g, double u) {
  const double m = 2 * u - 1, h = 1 + g * m;
  const double twice = 2 * m + g * (3 + m * m) + 2 * g * g * m - g * g * g * (1 - m * m);
  return twice / (2 * h * h);
}

}  // namespace microtrace
