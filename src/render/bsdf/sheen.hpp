#pragma once
/// Fibres that stand on a surface (A. Conty Estevez and C. Kulla, Production friendly microfacet
/// sheen BRDF, 2017), as KHR_materials_sheen has them. Local coordinates as in ggx.hpp.

#include <microtrace/math.hpp>

namespace microtrace::bsdf {

/// Smoother fibres are taken to have this roughness: below, the model returns more light than comes
/// at grazing angles.
inline constexpr float kLeastSheenRoughness = 0.25F;

class SheenLobe {
 public:
  explicit SheenLobe(float roughness);

  /// D V (1 for all that comes to fibres), for directions above the surface and their half vector.
  [[nodiscard]] float reflectance(const Vec3& wo, const Vec3& wi, const Vec3& h) const;

  /// The share of light from all around that goes to z = cos(theta), at most 1.
  [[nodiscard]] float albedo(float z) const;

 private:
  [[nodiscard]] double lambda(double cosine) const;

  double alpha_;
  float row_;  // of the table of albedos
};

}  // namespace microtrace::bsdf
