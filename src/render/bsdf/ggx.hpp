#pragma once
/// The microfacet distribution of B. Walter et al. (Microfacet models for refraction, 2007; "GGX")
/// with the masking of E. Heitz (Understanding the masking-shadowing function, 2014), for N lanes.
/// In local coordinates, z is the normal. Directions are unit vectors above the surface.

#include "render/bsdf/tables/tables.hpp"
#include "render/sampling/warps.hpp"
#include "simd/vector3.hpp"

#include <numbers>

namespace microtrace::bsdf {

inline constexpr float kInversePi = static_cast<float>(std::numbers::inv_pi);

/// Minimum alpha. Float32 is precise enough for this alpha. Sharper reflections would look the
/// same, because its lobe is already only a twentieth of a degree wide.
inline constexpr float kLeastAlpha = 0.001F;

/// Samples a microfacet normal that is visible from wo, for the given alphas along x and y (J.
/// Dupuy and A. Benyoub, Sampling visible GGX normals with spherical caps, 2023).
template <int N>
Floats3<N> visible_normal(const Float<N>& alpha_x, const Float<N>& alpha_y, const Floats3<N>& wo,
                          const Floats2<N>& u) {
  using F = Float<N>;
  using V = Floats3<N>;
  const V v = unit<N>(V{alpha_x * wo.x, alpha_y * wo.y, wo.z});
  const auto [cosine, sine] = sampling::unit_pair<N>(u.x);
  const F z = (1 - u.y) * (1 + v.z) - v.z;
  const F r = square_root<N>(larger_of(1 - z * z, F{}));
  return unit<N>(V{alpha_x * (r * cosine + v.x), alpha_y * (r * sine + v.y), z + v.z});
}

/// The isotropic distribution. All masking terms contain root(z) = sqrt(alpha^2 + (1 - alpha^2)
/// z^2) with z = cos(theta). For example, G1(z) = 2 z / (z + root(z)).
template <int N>
class Ggx {
 public:
  using F = Float<N>;
  using V = Floats3<N>;

  explicit Ggx(const F& roughness)
      : alpha_(larger_of(roughness * roughness, all<N>(kLeastAlpha))), square_(alpha_ * alpha_) {}

  [[nodiscard]] const F& alpha() const { return alpha_; }

  [[nodiscard]] F root(const F& z) const { return square_root<N>(square_ + (1 - square_) * z * z); }

  /// The density D(h) of microfacet normals, per solid angle.
  [[nodiscard]] F distribution(const V& h) const {
    const F q = (h.x * h.x + h.y * h.y) / square_ + h.z * h.z;
    return kInversePi / (square_ * q * q);
  }

  /// G2 / (4 z_o z_i) with height-correlated masking and shadowing.
  [[nodiscard]] F visibility(const F& z_o, const F& z_i) const {
    return 0.5F / (z_i * root(z_o) + z_o * root(z_i));
  }

  /// The same with the masking-shadowing term of glTF 2.0, section B.3.2: the product of both G1.
  [[nodiscard]] F spec_visibility(const V& wo, const V& wi) const {
    return 1 / ((wo.z + root(wo)) * (wi.z + root(wi)));
  }

  /// The pdf of wi, G1 D / (4 z_o), if its half vector is sampled by visible_normal(wo).
  /// `distribution` is D.
  [[nodiscard]] F reflected_pdf(const F& z_o, const F& distribution) const {
    return distribution / (2 * (z_o + root(z_o)));
  }

  // Overloads that take directions, as AnisotropicGgx does.
  [[nodiscard]] F root(const V& w) const { return root(w.z); }
  [[nodiscard]] F visibility(const V& wo, const V& wi) const { return visibility(wo.z, wi.z); }
  [[nodiscard]] F reflected_pdf(const V& wo, const F& distribution) const {
    return reflected_pdf(wo.z, distribution);
  }

  /// Samples a normal visible from wo.
  [[nodiscard]] V visible_normal(const V& wo, const Floats2<N>& u) const {
    return bsdf::visible_normal<N>(alpha_, alpha_, wo, u);
  }

 private:
  F alpha_, square_;
};

}  // namespace microtrace::bsdf
