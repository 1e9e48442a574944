#pragma once
#include "render/bsdf/anisotropic_ggx.hpp"
#include "render/bsdf/ggx_albedo.hpp"
#include "render/bsdf/polynomial.hpp"
#include "render/bsdf/tables/tables.hpp"

namespace microtrace::bsdf {

/// The directional albedo of anisotropic distributions, which also depends on the azimuth.
/// Otherwise like GgxAlbedo. Errors are mostly below half a percent.
template <int N>
class AnisotropicGgxAlbedo {
 public:
  using F = Float<N>;

  explicit AnisotropicGgxAlbedo(const AnisotropicGgx<N>& ggx)
      : ggx_(ggx),
        smaller_(square_root<N>(ggx.across_alpha())),
        range_(square_root<N>(ggx.along_alpha()) - smaller_) {
    const F x = 2 * smaller_ - 1, y = 2 * (smaller_ + range_) - 1;
    insert<N, 5>(kTables.anisotropic_loss, x, y, loss_);
    insert<N, 5>(kTables.anisotropic_schlick, x, y, edge_);
    // upper bound of the amount by which the polynomial is too small
    constexpr float margin = 0.0015F;
    mean_ = {1 - value<N, 7, 7>(kTables.mean_anisotropic_loss, x, y) - margin,
             value<N, 7, 7>(kTables.mean_anisotropic_schlick, x, y)};
  }

  /// The directional albedo for a direction above the surface.
  [[nodiscard]] Albedo<N> at(const Floats3<N>& w) const { return at(w.z, ggx_.alpha(w)); }

  /// The mean over all azimuths.
  [[nodiscard]] Albedo<N> around(const F& z) const {
    // Averages over the azimuth by Gauss quadrature with two nodes. The albedo is an even function
    // of twice the azimuth.
    const F a = ggx_.along_alpha() * ggx_.along_alpha();
    const F b = ggx_.across_alpha() * ggx_.across_alpha();
    constexpr float near = 0.853553391F;  // cos(22.5 degrees)^2
    const Albedo<N> first = at(z, square_root<N>(near * a + (1 - near) * b));
    const Albedo<N> second = at(z, square_root<N>((1 - near) * a + near * b));
    return {0.5F * (first.f1 + second.f1), 0.5F * (first.schlick + second.schlick)};
  }

  /// The cosine-weighted mean over all directions.
  [[nodiscard]] Albedo<N> mean() const { return mean_; }

 private:
  [[nodiscard]] Albedo<N> at(const F& z, const F& alpha) const {
    const F zero{}, one = all<N>(1);
    const F place = (square_root<N>(alpha) - smaller_) / larger_of(range_, all<N>(1e-6F));
    const F azimuth = 2 * clamped(place, zero, one) - 1, root = square_root<N>(z);
    const F loss =
        clamped(value<N, 5, 8>(loss_, azimuth, 2 * (z * (1 + alpha) / (z + alpha)) - 1), zero, one);
    const F more = range_ * (1 - root) * value<N, 6, 6>(edge_, azimuth, 2 * root - 1);
    return {1 - loss, clamped(GgxAlbedo<N>(alpha).at(z).schlick + more, zero, 1 - loss)};
  }

  AnisotropicGgx<N> ggx_;
  F smaller_, range_;  // square root of the smaller alpha, and the difference of the square roots
  F loss_[5 * 8], edge_[6 * 6];
  Albedo<N> mean_;
};

}  // namespace microtrace::bsdf
