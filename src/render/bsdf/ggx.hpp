#pragma once
/// The microfacet distribution of B. Walter et al. (Microfacet models for refraction, 2007; "GGX")
/// with the masking of E. Heitz (Understanding the masking-shadowing function, 2014). Local
/// coordinates: z is the normal; directions are unit vectors above the surface.

#include "render/bsdf/ggx_albedo_table.hpp"
#include "render/sampling/warps.hpp"

#include <microtrace/math.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace microtrace::bsdf {

inline constexpr float kInversePi = static_cast<float>(std::numbers::inv_pi);

/// Minimum alpha: reflections sharper than a twentieth of a degree are indistinguishable in a
/// picture, and float32 is precise enough for this alpha.
inline constexpr float kLeastAlpha = 0.001F;

/// Samples a normal visible from wo, for facets with these alphas along x and y (J. Dupuy and A.
/// Benyoub, Sampling visible GGX normals with spherical caps, 2023).
inline Vec3 visible_normal(float alpha_x, float alpha_y, const Vec3& wo, const Vec2& u) {
  Vec3 v(alpha_x * wo.x, alpha_y * wo.y, wo.z);
  v /= std::sqrt(glm::dot(v, v));
  const auto [cosine, sine] = sampling::unit_pair(u.x);
  const float z = (1 - u.y) * (1 + v.z) - v.z;
  const float r = std::sqrt(std::max(1 - z * z, 0.0F));
  const Vec3 h(alpha_x * (r * cosine + v.x), alpha_y * (r * sine + v.y), z + v.z);
  return h / std::sqrt(glm::dot(h, h));
}

class GgxAlbedo;

/// Isotropic. With z = cos(theta), root(z) = sqrt(alpha^2 + (1 - alpha^2) z^2) appears in all
/// masking terms: G1(z) = 2 z / (z + root(z)).
class Ggx {
 public:
  using DirectionalAlbedo = GgxAlbedo;

  explicit Ggx(float roughness)
      : alpha_(std::max(roughness * roughness, kLeastAlpha)), square_(alpha_ * alpha_) {}

  [[nodiscard]] float alpha() const { return alpha_; }

  [[nodiscard]] float root(float z) const { return std::sqrt(square_ + (1 - square_) * z * z); }

  /// The density of normals D(h) per solid angle.
  [[nodiscard]] float distribution(const Vec3& h) const {
    const float q = (h.x * h.x + h.y * h.y) / square_ + h.z * h.z;
    return kInversePi / (square_ * q * q);
  }

  /// G2 / (4 z_o z_i), height-correlated.
  [[nodiscard]] float visibility(float z_o, float z_i) const {
    return 0.5F / (z_i * root(z_o) + z_o * root(z_i));
  }

  /// The pdf of wi if its half vector is sampled by visible_normal(wo): G1 D / (4 z_o).
  [[nodiscard]] float reflected_pdf(float z_o, float distribution) const {
    return distribution / (2 * (z_o + root(z_o)));
  }

  // The same by directions, like AnisotropicGgx.
  [[nodiscard]] float root(const Vec3& w) const { return root(w.z); }
  [[nodiscard]] float visibility(const Vec3& wo, const Vec3& wi) const {
    return visibility(wo.z, wi.z);
  }
  [[nodiscard]] float reflected_pdf(const Vec3& wo, float distribution) const {
    return reflected_pdf(wo.z, distribution);
  }

  /// Samples a normal visible from wo.
  [[nodiscard]] Vec3 visible_normal(const Vec3& wo, const Vec2& u) const {
    return bsdf::visible_normal(alpha_, alpha_, wo, u);
  }

 private:
  float alpha_, square_;
};

/// The directional albedo of single scattering: for F = 1, and for F = (1 - cos)^5, the other part
/// of Schlick's Fresnel term. The albedo for F0 is F0 f1 + (1 - F0) schlick.
struct Albedo {
  float f1, schlick;
};

/// Directional albedos for one roughness.
class GgxAlbedo {
 public:
  explicit GgxAlbedo(const Ggx& ggx) : GgxAlbedo(ggx.alpha()) {}
  explicit GgxAlbedo(float alpha) : alpha_(alpha), row_(std::sqrt(alpha)) {}

  /// The albedo for light to or from z = cos(theta), in [0, 1].
  [[nodiscard]] Albedo at(float z) const {
    const Cell white(z * (1 + alpha_) / (z + alpha_)), edge(std::sqrt(z));
    return {.f1 = row_.mixed(white.mixed(kAlbedoF1[row_.first]),
                             white.mixed(kAlbedoF1[row_.first + 1])),
            .schlick = row_.mixed(edge.mixed(kAlbedoSchlick[row_.first]),
                                  edge.mixed(kAlbedoSchlick[row_.first + 1]))};
  }

  // The same by directions, like AnisotropicGgxAlbedo.
  [[nodiscard]] Albedo at(const Vec3& w) const { return at(w.z); }
  [[nodiscard]] Albedo around(float z) const { return at(z); }

  /// The cosine-weighted mean over all directions.
  [[nodiscard]] Albedo mean() const {
    return {.f1 = row_.mixed(kMeanAlbedoF1), .schlick = row_.mixed(kMeanAlbedoSchlick)};
  }

 private:
  /// A position between two entries of a table.
  struct Cell {
    std::size_t first;
    float share;

    explicit Cell(float s) {
      const float step = s * (kAlbedoSteps - 1);
      const int i = std::min(static_cast<int>(step), kAlbedoSteps - 2);
      first = static_cast<std::size_t>(i);
      share = step - static_cast<float>(i);
    }
    [[nodiscard]] float mixed(float a, float b) const { return a + share * (b - a); }
    [[nodiscard]] float mixed(const std::array<float, kAlbedoSteps>& steps) const {
      return mixed(steps[first], steps[first + 1]);
    }
  };

  float alpha_;
  Cell row_;
};

}  // namespace microtrace::bsdf
