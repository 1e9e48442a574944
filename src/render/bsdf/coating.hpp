#pragma once
/// Transmittance of coatings, for N lanes, in the local coordinates of surface.hpp.

#include "render/bsdf/frame.hpp"
#include "render/bsdf/ggx_albedo.hpp"
#include "render/bsdf/sheen.hpp"
#include "render/bsdf/surface.hpp"
#include "simd/gather.hpp"

#include <cstddef>

namespace microtrace::bsdf {

/// Sheen below a clear coat. The layers' transmittance is the fraction of light that they do not
/// reflect. The base is scaled by the smaller transmittance of wo and wi, as in
/// KHR_materials_sheen. This loses energy where microfacets scatter light into directions of lower
/// transmittance. deficit() returns the lost energy, which the base adds in other directions.
template <int N>
class Coating {
 public:
  using F = Float<N>;
  using V = Floats3<N>;

  /// Fresnel reflectance of the coat, whose index of refraction is 1.5.
  static Schlick<N> fresnel() { return {}; }

  explicit Coating(const Surface<N>& surface)
      : coat_weight_(surface.coat),
        greatest_sheen_(greatest_component(surface.sheen)),
        sheen_(surface.sheen_roughness),
        coat_(surface.coat_roughness),
        coat_albedo_(coat_),
        coat_frame_(Frame<N>::about(surface.coat_normal)) {
    // The cosine and sine of the angle between the coat's normal and the shading normal.
    const F one = all<N>(1);
    const F turn_cos = clamped(coat_weight_ > 0 ? surface.coat_normal.z : one, F{}, one);
    turn_sin_ = square_root<N>(1 - turn_cos * turn_cos);
    alpha_ = larger_of(F(surface.roughness * surface.roughness), all<N>(1e-6F));
    for (int k = 0; k < kNodes; ++k) {
      const F z = all<N>(kTables.coating_node[k]), through = sheen_transmittance(z);
      if (!any(turn_sin_ > 0)) {
        node_transmittance_[k] = coat_transmittance(z) * through;
        continue;
      }
      const Around around = coat_around(z, turn_cos);
      node_transmittance_[k] = around.mean * through;
      const Slopes slopes = slopes_at(z);
      const F least = slopes.least * through;
      node_change_square_[k] = around.square * least * least;
      node_rise_[k] = (slopes.rise * through - least) * square_root<N>(around.square);
    }
    // Reduces the tabulated deficit where it is too large: for anisotropic microfacets, and for
    // sheen peaks narrower than the spacing of the nodes.
    F trust = surface.anisotropy > 0 ? all<N>(0.4F) : one;
    const F wide = clamped(F(5 * surface.sheen_roughness - 0.25F), F{}, one);
    trust = greatest_sheen_ > 0 ? trust * wide : trust;
    // The tables assume a coat with the shading normal.
    trust = trust * larger_of(F(1 - kTurnLoss * turn_sin_), F{});
    const int rows = kCoatingRows;
    const Cell<N> row(square_root<N>(surface.roughness) * static_cast<float>(rows - 1), rows);
    for (int i = 0; i < kColumns; ++i) {
      deficit_f1_[i] = mixed(kTables.deficit_f1, row, i) * trust;
      deficit_schlick_[i] = mixed(kTables.deficit_schlick, row, i) * trust;
    }
  }

  /// The transmittance of the coat, or of all layers, for a direction above the surface.
  [[nodiscard]] F coat_transmittance(const V& w) const {
    return coat_transmittance(smaller_of(magnitude(coat_frame_.to_local(w).z), all<N>(1)));
  }
  [[nodiscard]] F transmittance(const V& w) const {
    return coat_transmittance(w) * sheen_transmittance(w.z);
  }
  /// The transmittance of all layers at this angle to the coat's normal and to that of the sheen.
  [[nodiscard]] F transmittance(const F& cosine) const {
    return coat_transmittance(cosine) * sheen_transmittance(cosine);
  }

  /// The weight of the coat's reflection according to fresnel_coat of KHR_materials_clearcoat. The
  /// layers below have the remaining weight.
  [[nodiscard]] F spec_coat_weight(const V& w) const {
    return coat_weight_ * fresnel()(magnitude(coat_frame_.to_local(w).z)).x;
  }
  /// The transmittance of the sheen for z = |cos(theta)| (sheen_albedo_scaling of
  /// KHR_materials_sheen).
  [[nodiscard]] F sheen_transmittance(const F& z) const {
    if (less<N>(F{}, greatest_sheen_) == 0) return all<N>(1);
    const F left = 1 - greatest_sheen_ * sheen_.albedo(z);
    return greatest_sheen_ > 0 ? left : all<N>(1);
  }

  /// The energy deficit for light to or from z = cos(theta), below a coat with the shading normal.
  /// It is the microfacets' albedo if all directions had the transmittance of z, minus the actual
  /// albedo.
  [[nodiscard]] Albedo<N> deficit(const F& z) const {
    const Cell<N> cell(square_root<N>(z) * (kColumns - 1), kColumns);
    return {cell.mixed(picked<N>(deficit_f1_, cell.first), picked<N>(deficit_f1_ + 1, cell.first)),
            cell.mixed(picked<N>(deficit_schlick_, cell.first),
                       picked<N>(deficit_schlick_ + 1, cell.first))};
  }
  /// The energy deficit for light to or from w, below any coat. `transmittance` is that of the
  /// layers for w, and `albedo` that of the microfacets.
  [[nodiscard]] Albedo<N> deficit(const V& w, const F& transmittance,
                                  const Albedo<N>& albedo) const {
    const Albedo<N> mean = deficit(w.z);
    if (!any(turn_sin_ > 0)) return mean;
    const F difference = transmittance - this->transmittance(V{-w.x, -w.y, w.z});
    // A fall counts twice, because a deficit that is too large would add energy.
    const Slopes slopes = slopes_at(w.z);
    const F change = difference * (difference < 0 ? 2 * slopes.least : slopes.rise);
    return {larger_of(F(mean.f1 + change * albedo.f1), F{}),
            larger_of(F(mean.schlick + change * albedo.schlick), F{})};
  }
  /// An upper bound of the mean of deficit() over the directions with the cosine of node k.
  [[nodiscard]] Albedo<N> deficit_at_node(int k, const Albedo<N>& albedo) const {
    const Albedo<N> mean = deficit(all<N>(kTables.coating_node[k]));
    if (!any(turn_sin_ > 0)) return mean;
    // See docs/derivations.md, "Turned coats".
    const auto changed = [&](const F& deficit, const F& reflected) {
      const F square = deficit * deficit + node_change_square_[k] * reflected * reflected;
      const F rise = node_rise_[k] * reflected;
      return turn_sin_ > 0 ? 0.5F * (deficit + square_root<N>(square) + rise) : deficit;
    };
    return {changed(mean.f1, albedo.f1), changed(mean.schlick, albedo.schlick)};
  }

  /// The mean of transmittance() over the directions with the cosine of node k.
  [[nodiscard]] const F& transmittance_at_node(int k) const { return node_transmittance_[k]; }

  [[nodiscard]] const SheenLobe<N>& sheen() const { return sheen_; }
  [[nodiscard]] const F& greatest_sheen() const { return greatest_sheen_; }
  [[nodiscard]] const Ggx<N>& coat() const { return coat_; }
  [[nodiscard]] const Frame<N>& coat_frame() const { return coat_frame_; }

 private:
  static constexpr int kNodes = kCoatingNodes, kColumns = kCoatingColumns;
  // Of the tabulated deficit, this times the sine of the coat's turn is not compensated.
  static constexpr float kTurnLoss = 0.5F;

  [[nodiscard]] F coat_transmittance(const F& z) const {
    if (less<N>(F{}, coat_weight_) == 0) return all<N>(1);
    const Albedo<N> albedo = coat_albedo_.at(z);
    const Schlick<N> schlick = fresnel();
    const F left =
        1 - coat_weight_ * (schlick.f0.x * (albedo.f1 - albedo.schlick) + albedo.schlick);
    return coat_weight_ == 0 ? all<N>(1) : left;
  }
  /// How much the deficit for a direction with z = cos(theta) grows with the difference between its
  /// transmittance and that of the opposite direction, for an albedo of 1. This approximates the
  /// fraction of the light that microfacets reflect into directions of lower transmittance.
  struct Slopes {
    F least;  ///< for small differences
    F rise;   ///< for positive differences; 1 for smooth facets, which reflect into one direction
  };
  [[nodiscard]] Slopes slopes_at(const F& z) const {
    const F least = 0.2F * (2 - alpha_) * z / (z + alpha_), square = z * z;
    const F smooth = square / (square + 25 * alpha_ * alpha_);
    return {least, least + (1 - least) * smooth};
  }
  /// The transmittance of the coat for the directions at z = cos(theta).
  struct Around {
    F mean;
    F square;  ///< mean square of the difference between opposite directions
  };
  [[nodiscard]] Around coat_around(const F& z, const F& turn_cos) const {
    // Uses the azimuths of Gauss-Chebyshev quadrature. Where the coat isn't turned, all four
    // transmittances are equal, and so is their mean.
    constexpr float kAzimuths[] = {0.92387953F, 0.38268343F};
    const F along = z * turn_cos, across = square_root<N>(1 - z * z) * turn_sin_;
    F sum{}, square{};
    for (const float azimuth : kAzimuths) {
      const F toward = coat_transmittance(smaller_of(F(along + azimuth * across), all<N>(1)));
      const F away = coat_transmittance(magnitude(F(along - azimuth * across)));
      sum += toward + away;
      square += (toward - away) * (toward - away);
    }
    return {0.25F * sum, 0.5F * square};
  }
  [[nodiscard]] F mixed(const float* table, const Cell<N>& row, std::ptrdiff_t column) const {
    F upper{}, lower{};
    for (int k = 0; k < kNodes; ++k) {
      const float* entries = &table[(column * kNodes + k) * kPaddedRows];
      upper += node_transmittance_[k] * gathered_of_16<N>(entries, row.first);
      lower += node_transmittance_[k] * gathered_of_16<N>(entries, row.first + 1);
    }
    return larger_of(row.mixed(upper, lower) * kDeficitUnit, F{});
  }

  F coat_weight_, greatest_sheen_;  // greatest_sheen_ is the maximum over the color channels
  SheenLobe<N> sheen_;
  Ggx<N> coat_;
  GgxAlbedo<N> coat_albedo_;
  Frame<N> coat_frame_;
  F turn_sin_, alpha_;
  F node_transmittance_[kCoatingNodes];
  F node_change_square_[kCoatingNodes], node_rise_[kCoatingNodes];
  F deficit_f1_[kCoatingColumns], deficit_schlick_[kCoatingColumns];
};

/// The coatings on the two sides of a surface; null where there is none. Thin walls have the same
/// coating on both sides, and refracting surfaces only on the outside.
template <int N>
struct Coatings {
  const Coating<N>* above = nullptr;
  const Coating<N>* below = nullptr;
};

}  // namespace microtrace::bsdf
