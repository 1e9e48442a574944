#pragma once
#include "render/bsdf/anisotropic_ggx.hpp"
#include "render/bsdf/anisotropic_loss_table.hpp"
#include "render/bsdf/ggx.hpp"

#include <microtrace/math.hpp>

namespace microtrace::bsdf {

/// What GgxAlbedo is, where it depends on azimuths too: within half a per cent, mostly.
class AnisotropicGgxAlbedo {
 public:
  explicit AnisotropicGgxAlbedo(const AnisotropicGgx& ggx);

  /// Of light to or from a direction above the surface.
  [[nodiscard]] Albedo at(const Vec3& w) const { return at(w.z, ggx_.alpha(w)); }

  /// The mean of the azimuths.
  [[nodiscard]] Albedo around(float z) const;

  /// The cosine-weighted mean of all directions.
  [[nodiscard]] Albedo mean() const { return mean_; }

 private:
  [[nodiscard]] Albedo at(float z, float alpha) const;

  AnisotropicGgx ggx_;
  float smaller_, range_;  // roots of alphas: the smaller, and how far the greater is from it
  AnisotropicLossPlane loss_;
  AnisotropicEdgePlane edge_;
  Albedo mean_;
};

}  // namespace microtrace::bsdf
