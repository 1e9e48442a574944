#pragma once
/// Directional albedos of microfacets, for N lanes.

#include "render/bsdf/ggx.hpp"
#include "render/bsdf/table_cell.hpp"
#include "render/bsdf/tables/tables.hpp"

namespace microtrace::bsdf {

/// The directional albedos of single scattering: `f1` for F = 1, and `schlick` for F = (1 - cos)^5,
/// the second part of Schlick's Fresnel term. The albedo for a reflectance F0 is F0 f1 + (1 - F0)
/// schlick.
template <int N>
struct Albedo {
  Float<N> f1, schlick;
};

/// Schlick's Fresnel term of the brightest color channel. The base receives the energy that is not
/// reflected in this channel.
template <int N>
struct GreatestSchlick {
  Float<N> f0, f90;

  [[nodiscard]] Float<N> albedo(const Albedo<N>& a) const {
    return f0 * (a.f1 - a.schlick) + f90 * a.schlick;
  }
};

/// Directional albedos of GGX for one roughness.
template <int N>
class GgxAlbedo {
 public:
  using F = Float<N>;

  explicit GgxAlbedo(const Ggx<N>& ggx) : GgxAlbedo(ggx.alpha()) {}
  explicit GgxAlbedo(const F& alpha)
      : alpha_(alpha), row_(square_root<N>(alpha) * (kAlbedoSteps - 1), kAlbedoSteps) {}

  /// The albedo for light to or from z = cos(theta), in [0, 1].
  [[nodiscard]] Albedo<N> at(const F& z) const {
    return {between_rows(kTables.albedo_f1, z * (1 + alpha_) / (z + alpha_)),
            between_rows(kTables.albedo_schlick, square_root<N>(z))};
  }

  // Overloads that match those of AnisotropicGgxAlbedo.
  [[nodiscard]] Albedo<N> at(const Floats3<N>& w) const { return at(w.z); }
  [[nodiscard]] Albedo<N> around(const F& z) const { return at(z); }

  /// The cosine-weighted mean over all directions.
  [[nodiscard]] Albedo<N> mean() const {
    const auto& [v] = Quad<N>(kTables.mean_albedos, row_.first);
    return {row_.mixed(v[0], v[1]), row_.mixed(v[2], v[3])};
  }

 private:
  [[nodiscard]] F between_rows(const float* table, const F& place) const {
    const Cell<N> column(place * (kAlbedoSteps - 1), kAlbedoSteps);
    return interpolated<N>(table, kAlbedoSteps, row_, column);
  }

  F alpha_;
  Cell<N> row_;
};

}  // namespace microtrace::bsdf
