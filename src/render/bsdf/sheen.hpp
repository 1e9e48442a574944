#pragma once
/// Fibres that stand on a surface (A. Conty Estevez and C. Kulla, Production friendly microfacet
/// sheen BRDF, 2017), as KHR_materials_sheen has them. Local coordinates as in ggx.hpp.

#include "render/bsdf/sheen_table.hpp"

#include <microtrace/math.hpp>

namespace microtrace::bsdf {

/// Smoother fibres are taken to have this roughness: then they shine within some five degrees of
/// the surface only.
inline constexpr float kLeastSheenRoughness = 0.05F;

/// The model as published returns more light than comes where smooth fibres are seen at a slant: up
/// to 4 times. There it is divided by what it returns in all, to wo or from wi, whichever is more.
class SheenLobe {
 public:
  explicit SheenLobe(float roughness);

  /// D V (1 for all that comes to fibres), for directions above the surface and their half vector.
  [[nodiscard]] float reflectance(const Vec3& wo, const Vec3& wi, const Vec3& h) const;

  /// The share of light from all around that goes to z = cos(theta), at most 1.
  [[nodiscard]] float albedo(float z) const { return look_up(kSheenAlbedo, z); }

  /// A direction above the surface, lower the smoother the fibres are, and its density.
  [[nodiscard]] Vec3 direction(const Vec2& u) const;
  [[nodiscard]] float density(float z) const;

 private:
  [[nodiscard]] float look_up(const SheenTable& table, float z) const;
  [[nodiscard]] double lambda(double cosine) const;

  float roughness_;
  double alpha_;
  float row_;  // of the tables
};

}  // namespace microtrace::bsdf
