#pragma once
/// Sheen of fibers on a surface (A. Conty Estevez and C. Kulla, Production friendly microfacet
/// sheen BRDF, 2017), as in KHR_materials_sheen, for N lanes, in the local coordinates of ggx.hpp.

#include "render/bsdf/table_cell.hpp"
#include "render/bsdf/tables/tables.hpp"
#include "simd/exponential.hpp"

#include <numbers>

namespace microtrace::bsdf {

/// The minimum roughness. Smoother fibers would be visible only within about five degrees of the
/// surface.
inline constexpr float kLeastSheenRoughness = 0.05F;

/// Computes the terms of the model that need float64.
template <int N>
struct SheenTerms {
  using D = Double<N>;

  D alpha;

  /// The exponent in the paper's fit of the masking function.
  [[nodiscard]] D fit(const D& x) const {
    const D t = (1 - alpha) * (1 - alpha);
    const auto mix = [&](double rough, double smooth) { return rough + t * (smooth - rough); };
    const D a = mix(21.5473, 25.3245), b = mix(3.82987, 3.32435), c = mix(0.19823, 0.16801),
            d = mix(-1.97760, -1.27393), e = mix(-4.32054, -4.85967);
    return a / (1 + b * power<N>(x, c)) + d * x + e;
  }

  [[nodiscard]] D lambda(const D& cosine) const {
    const auto is_low = cosine < 0.5;
    const D at = fit(is_low ? cosine : 1 - cosine);
    return exponential<N>(is_low ? at : 2 * fit(D{} + 0.5) - at);
  }

  /// D V for a half vector with h.z = sqrt(1 - sine_square).
  [[nodiscard]] D reflectance(const D& z_o, const D& z_i, const D& sine_square) const {
    const D d = (2 + 1 / alpha) * power<N>(smaller_of(sine_square, D{} + 1), 0.5 / alpha) *
                (0.5 * std::numbers::inv_pi);
    return d / (4 * (1 + lambda(z_o) + lambda(z_i)) * z_o * z_i);
  }
};

/// Sheen without its color.
template <int N>
class SheenLobe {
 public:
  using F = Float<N>;
  using V = Floats3<N>;

  explicit SheenLobe(const F& roughness)
      : roughness_(clamped(roughness, all<N>(kLeastSheenRoughness), all<N>(1))),
        row_(square_root<N>((roughness_ - kLeastSheenRoughness) / (1 - kLeastSheenRoughness)) *
                 (kSheenRows - 1),
             kSheenRows) {}

  /// D V without the color, for directions wo and wi above the surface and their half vector h. The
  /// albedo of the published model reaches 4 for smooth fibers at grazing angles. Where it exceeds
  /// 1, the model is divided by its albedo for wo or wi, whichever is larger.
  [[nodiscard]] F reflectance(const V& wo, const V& wi, const V& h) const {
    const F most =
        larger_of(look_up(kTables.raw_sheen_albedo, wo.z), look_up(kTables.raw_sheen_albedo, wi.z));
    return published_reflectance(wo, wi, h) / larger_of(most, all<N>(1));
  }

  /// D V of the published model.
  [[nodiscard]] F published_reflectance(const V& wo, const V& wi, const V& h) const {
    constexpr int n = kDoubleLanes<N>;
    alignas(64) float roughness[N], z_o[N], z_i[N], x[N], y[N], values[N];
    store<N>(roughness, roughness_);
    store<N>(z_o, wo.z);
    store<N>(z_i, wi.z);
    store<N>(x, h.x);
    store<N>(y, h.y);
    for (int i = 0; i < N; i += n) {
      const Double<n> r = widened<n>(roughness + i), h_x = widened<n>(x + i),
                      h_y = widened<n>(y + i);
      const SheenTerms<n> terms{r * r};
      narrowed<n>(
          terms.reflectance(widened<n>(z_o + i), widened<n>(z_i + i), h_x * h_x + h_y * h_y),
          values + i);
    }
    return load<N>(values);
  }

  /// The directional albedo for z = cos(theta), at most 1.
  [[nodiscard]] F albedo(const F& z) const { return look_up(kTables.sheen_albedo, z); }

  /// Samples a direction above the surface. Smoother fibers give lower elevations: z has the pdf b
  /// (1 + b) / (z + b)^2.
  [[nodiscard]] V direction(const Floats2<N>& u) const {
    const F b = 2 * roughness_, z = smaller_of(u.y * b / (1 + b - u.y), all<N>(1));
    const auto [cosine, sine] = sampling::unit_pair<N>(u.x);
    const F r = square_root<N>(1 - z * z);
    return {r * cosine, r * sine, z};
  }
  [[nodiscard]] F pdf(const F& z) const {
    const F b = 2 * roughness_;
    return 0.5F * kInversePi * b * (1 + b) / ((z + b) * (z + b));
  }

 private:
  [[nodiscard]] F look_up(const float* table, const F& z) const {
    const F bend = 0.5F * roughness_, height = clamped(z, F{}, all<N>(1));
    const Cell<N> column(height * (1 + bend) / (height + bend) * (kSheenColumns - 1),
                         kSheenColumns);
    return interpolated<N>(table, kSheenColumns, row_, column);
  }

  F roughness_;
  Cell<N> row_;  // position in the tables
};

}  // namespace microtrace::bsdf
