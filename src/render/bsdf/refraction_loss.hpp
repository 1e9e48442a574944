#pragma once
#include "render/bsdf/dielectric_bound.hpp"
#include "render/bsdf/refraction_loss_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace microtrace::bsdf {

/// The energy deficit of single scattering at a rough refracting boundary, on both sides, and the
/// division of its multiple scattering between the sides (C. Kulla and A. Conty, Revisiting
/// physically based shading at Imageworks, 2017). Never more than the actual loss.
class RefractionLoss {
 public:
  /// No loss.
  RefractionLoss() = default;

  /// eta: the index of refraction below divided by that above, not 1.
  RefractionLoss(float roughness, float eta, const GreatestSchlick& dielectric);

  /// The loss for light to or from z = cos(theta) above the surface, or -z below it.
  [[nodiscard]] float above(float z) const { return above_is_thinner_ ? outside(z) : within(z); }
  [[nodiscard]] float below(float z) const { return above_is_thinner_ ? within(z) : outside(z); }

  /// Cosine-weighted means of the losses.
  [[nodiscard]] float mean_above() const {
    return above_is_thinner_ ? mean_outside_ : mean_within_;
  }
  [[nodiscard]] float mean_below() const {
    return above_is_thinner_ ? mean_within_ : mean_outside_;
  }

  /// The fraction of the loss above that multiple scattering transmits; the rest is reflected.
  [[nodiscard]] float through() const { return through_; }

 private:
  using Columns = std::array<float, kLossColumns>;

  [[nodiscard]] static float mixed(const Columns& columns, float step) {
    const auto first = std::min(static_cast<std::size_t>(step), kLossColumns - 2);
    return columns[first] +
           (step - static_cast<float>(first)) * (columns[first + 1] - columns[first]);
  }
  [[nodiscard]] float outside(float z) const {
    return mixed(outside_, std::sqrt(z) * (kLossColumns - 1));
  }
  [[nodiscard]] float within(float z) const {
    constexpr std::size_t middle = (kLossColumns - 1) / 2;
    constexpr auto half = static_cast<float>(middle);
    if (z < critical_) return mixed(within_, half * std::sqrt(z / critical_));
    return mixed(within_, half + half * std::sqrt((z - critical_) / (1 - critical_)));
  }

  bool above_is_thinner_ = true;
  float critical_ = 0.5F;  // cosine of the critical angle
  Columns outside_{}, within_{};
  float mean_outside_ = 0, mean_within_ = 0, through_ = 0;
};

}  // namespace microtrace::bsdf
