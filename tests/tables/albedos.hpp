#pragma once
/// Computes the integrals that the tables of src/render/bsdf approximate, in float64.

#include "tables/facets.hpp"
#include "tables/quadrature.hpp"

namespace microtrace::tables {

/// Returns the alpha of bsdf::Ggx for this roughness.
[[nodiscard]] double alpha_of(double roughness);

[[nodiscard]] double fifth_power(double x);

/// The albedo for a Fresnel term of F = 1, and for F = (1 - cos)^5.
struct Albedo {
  double f1 = 0, schlick = 0;
};

/// Returns the directional albedo of single scattering for light to or from wo.
[[nodiscard]] Albedo ggx_albedo(const Alphas& alphas, const Direction& wo,
                                const Quadrature& points);

/// The fraction of the light that single scattering at a rough boundary neither reflects nor
/// refracts. It is a linear function of f0 and f90 of Schlick's Fresnel term, as facets with total
/// reflection depend on neither.
struct RefractionLoss {
  double loss = 0;               ///< for the f0 that follows from the index, and f90 = 1
  double by_f0 = 0, by_f90 = 0;  ///< derivatives
};

/// Returns the loss for light from z = cos(theta). eta is the index of refraction behind the
/// boundary divided by that in front of it. The Fresnel term is for the cosine in the medium with
/// the lower index. Of the two masking terms of refraction, the smaller one applies.
[[nodiscard]] RefractionLoss refraction_loss(double alpha, double z, double eta,
                                             const Quadrature& points);

/// The published sheen model (A. Conty Estevez and C. Kulla, Production friendly microfacet sheen
/// BRDF, 2017).
class Sheen {
 public:
  explicit Sheen(double roughness) : alpha_(roughness * roughness) {}

  [[nodiscard]] double lambda(double z) const;

  /// Integrates D V over the azimuth. z and z_in are the cosines of wo and wi, and `masking` is 1 +
  /// lambda(z) + lambda(z_in). `points` must be graded.
  [[nodiscard]] double around(double z, double z_in, double masking,
                              const Quadrature& points) const;

  /// Returns the directional albedo.
  [[nodiscard]] double albedo(double z, const Quadrature& points) const;

 private:
  double alpha_;
};

}  // namespace microtrace::tables
