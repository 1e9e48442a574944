#include "render/media/medium.hpp"

#include "scene/math/exponential.hpp"

#include <algorithm>
#include <cmath>

namespace microtrace {
namespace {

/// Forward scattering beyond this limit is hardly different from no scattering.
constexpr float kMostAnisotropy = 0.9999F;

/// Extinction by which all light is lost within any distance that float32 can resolve.
constexpr double kMostExtinction = 0x1p100;

}  // namespace

double single_scattering_albedo(double multiple_scattering_albedo) {
  const double a = multiple_scattering_albedo;
  if (a == 0) return 0;  // where the fit has 6e-6
  const double s = 4.09712 + 4.20863 * a - std::sqrt(9.59217 + 41.6808 * a + 17.7126 * a * a);
  return std::clamp(1 - s * s, 0.0, 1.0);
}

float Medium::ior_of(int channel) const {
  if (channel == 3) return ior;
  const float half_spread = (ior - 1) * 0.025F * dispersion;
  return std::max(ior + static_cast<float>(channel - 1) * half_spread, 1.0F);
}

Medium medium_of(const Material& m) {
  Medium medium{.ior = m.ior == 0 ? 1e6F : m.ior, .dispersion = m.dispersion};
  for (int c = 0; c < 3; ++c) {
    // By the Beer-Lambert law, the transmittance after a length l is color^(l / distance).
    const double left = std::clamp<double>(m.volume->attenuation_color[c], 0x1p-30, 1);
    const double extinction = -binary_logarithm(left) / m.volume->attenuation_distance;
    medium.extinction[c] = static_cast<float>(std::min(extinction, kMostExtinction));
    if (m.volume_scatter && medium.extinction[c] > 0) {
      medium.albedo[c] =
          static_cast<float>(single_scattering_albedo(m.volume_scatter->multiscatter_color[c]));
    }
  }
  if (m.volume_scatter) {
    medium.color = m.volume_scatter->multiscatter_color;
    medium.anisotropy = std::clamp(m.volume_scatter->anisotropy, -kMostAnisotropy, kMostAnisotropy);
  }
  return medium;
}

}  // namespace microtrace
