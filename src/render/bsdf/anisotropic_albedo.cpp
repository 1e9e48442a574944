#include "render/bsdf/anisotropic_albedo.hpp"

#include <algorithm>
#include <cmath>

namespace microtrace::bsdf {

AnisotropicGgxAlbedo::AnisotropicGgxAlbedo(const AnisotropicGgx& ggx)
    : ggx_(ggx),
      smaller_(std::sqrt(ggx.across_alpha())),
      range_(std::sqrt(ggx.along_alpha()) - smaller_) {
  const float x = 2 * smaller_ - 1, y = 2 * (smaller_ + range_) - 1;
  loss_ = plane_at(kAnisotropicLoss, x, y);
  edge_ = plane_at(kAnisotropicSchlick, x, y);
  // the value may be too small by this much
  constexpr float margin = 0.0015F;
  mean_ = {.f1 = 1 - value(kMeanAnisotropicLoss, x, y) - margin,
           .schlick = value(kMeanAnisotropicSchlick, x, y)};
}

Albedo AnisotropicGgxAlbedo::at(float z, float alpha) const {
  const float place = (std::sqrt(alpha) - smaller_) / std::max(range_, 1e-6F);
  const float azimuth = 2 * std::clamp(place, 0.0F, 1.0F) - 1, root = std::sqrt(z);
  const float loss =
      std::clamp(value(loss_, azimuth, 2 * (z * (1 + alpha) / (z + alpha)) - 1), 0.0F, 1.0F);
  const float more = range_ * (1 - root) * value(edge_, azimuth, 2 * root - 1);
  return {.f1 = 1 - loss,
          .schlick = std::clamp(GgxAlbedo(alpha).at(z).schlick + more, 0.0F, 1 - loss)};
}

Albedo AnisotropicGgxAlbedo::around(float z) const {
  // Gauss quadrature over the azimuth, for even functions of twice the angle.
  const float a = ggx_.along_alpha() * ggx_.along_alpha();
  const float b = ggx_.across_alpha() * ggx_.across_alpha();
  constexpr float near = 0.853553391F;  // cos(22.5 degrees)^2
  const Albedo first = at(z, std::sqrt(near * a + (1 - near) * b));
  const Albedo second = at(z, std::sqrt((1 - near) * a + near * b));
  return {.f1 = 0.5F * (first.f1 + second.f1), .schlick = 0.5F * (first.schlick + second.schlick)};
}

}  // namespace microtrace::bsdf
