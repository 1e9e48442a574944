#pragma once
/// Sheen: fibers on a surface (A. Conty Estevez and C. Kulla, Production friendly microfacet sheen
/// BRDF, 2017), as in KHR_materials_sheen. Local coordinates as in ggx.hpp.

#include "render/bsdf/sheen_table.hpp"

#include <microtrace/math.hpp>

namespace microtrace::bsdf {

/// Minimum roughness: such fibers are visible only within some five degrees of the surface.
inline constexpr float kLeastSheenRoughness = 0.05F;

/// The published model has an albedo of up to 4 for smooth fibers at grazing angles. There it is
/// divided by its albedo for wo or wi, whichever is larger.
class SheenLobe {
 public:
  explicit SheenLobe(float roughness);

  /// D V without color, for directions above the surface and their half vector.
  [[nodiscard]] float reflectance(const Vec3& wo, const Vec3& wi, const Vec3& h) const;

  /// The directional albedo for z = cos(theta), at most 1.
  [[nodiscard]] float albedo(float z) const { return look_up(kSheenAlbedo, z); }

  /// Samples a direction above the surface, lower for smoother fibers, and its pdf.
  [[nodiscard]] Vec3 direction(const Vec2& u) const;
  [[nodiscard]] float pdf(float z) const;

 private:
  [[nodiscard]] float look_up(const SheenTable& table, float z) const;
  [[nodiscard]] double lambda(double cosine) const;

  float roughness_;
  double alpha_;
  float row_;  // position in the tables
};

}  // namespace microtrace::bsdf
