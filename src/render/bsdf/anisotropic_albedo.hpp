#pragma once
#include "render/bsdf/anisotropic_ggx.hpp"
#include "render/bsdf/anisotropic_loss_table.hpp"
#include "render/bsdf/ggx.hpp"

#include <microtrace/math.hpp>

namespace microtrace::bsdf {

/// GgxAlbedo for anisotropic distributions, where it also depends on the azimuth; mostly accurate
/// to half a percent.
class AnisotropicGgxAlbedo {
 public:
  explicit AnisotropicGgxAlbedo(const AnisotropicGgx& ggx);

  /// The directional albedo for a direction above the surface.
  [[nodiscard]] Albedo at(const Vec3& w) const { return at(w.z, ggx_.alpha(w)); }

  /// The mean over all azimuths.
  [[nodiscard]] Albedo around(float z) const;

  /// The cosine-weighted mean over all directions.
  [[nodiscard]] Albedo mean() const { return mean_; }

 private:
  [[nodiscard]] Albedo at(float z, float alpha) const;

  AnisotropicGgx ggx_;
  float smaller_, range_;  // square roots of the alphas: the smaller one, and the difference
  AnisotropicLossPlane loss_;
  AnisotropicSchlickPlane edge_;
  Albedo mean_;
};

}  // namespace microtrace::bsdf
