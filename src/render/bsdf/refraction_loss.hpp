#pragma once
#include "render/bsdf/ggx_albedo.hpp"
#include "render/bsdf/tables/tables.hpp"
#include "simd/gather.hpp"

namespace microtrace::bsdf {

/// Quadratic Lagrange interpolation at x between three neighboring nodes out of n equidistant nodes
/// in [0, 1].
template <int N>
struct Parabola {
  Int<N> first;
  Float<N> weights[3];

  Parabola(const Float<N>& x, int n) {
    const Float<N> step = x * static_cast<float>(n - 1);
    // `step` is not negative, and ties may round either way.
    // NOLINTNEXTLINE(bugprone-incorrect-roundings)
    const Int<N> nearest = truncated<N>(step + 0.5F);
    const Int<N> least = Int<N>{} + 1, last = Int<N>{} + (n - 3);
    const Int<N> before = larger_of(nearest, least) - 1;
    first = smaller_of(before, last);
    const Float<N> p = step - to_float<N>(first);
    weights[0] = (p - 1) * (p - 2) * 0.5F;
    weights[1] = p * (2 - p);
    weights[2] = p * (p - 1) * 0.5F;
  }
};

template <int n>
struct HatWeights {
  float value[n];
};

/// The integrals over [0, 1] of (m + 1) x^m times each of the piecewise linear hat functions of n
/// equidistant points.
template <int m, int n>
constexpr HatWeights<n> hat_weights() {
  const auto power = [](double x, int k) {
    double result = 1;
    while (k-- > 0) result *= x;
    return result;
  };
  HatWeights<n> result{};
  const double cells = n - 1;
  for (int i = 0; i + 1 < n; ++i) {
    const double a = i / cells, b = (i + 1) / cells;
    const double all = power(b, m + 1) - power(a, m + 1);
    const double moment = (power(b, m + 2) - power(a, m + 2)) * (m + 1) / (m + 2);
    const double upper = (moment - a * all) * cells;
    result.value[i] += static_cast<float>(all - upper);
    result.value[i + 1] += static_cast<float>(upper);
  }
  return result;
}

/// The energy deficit of single scattering at a rough refracting boundary, for light from either
/// side, and the distribution of multiple scattering between the two sides (C. Kulla and A. Conty,
/// Revisiting physically based shading at Imageworks, 2017). The computed deficit rarely exceeds
/// the actual one.
template <int N>
class RefractionLoss {
 public:
  using F = Float<N>;

  /// Constructs a boundary without loss.
  RefractionLoss() = default;

  /// What the loss depends on. The members after `dielectric` make the computed loss smaller where
  /// it is less certain.
  struct Boundary {
    F roughness;
    F eta;  ///< the index of refraction below divided by the index above; not 1
    GreatestSchlick<N> dielectric;
    F least_f0, most_f0;       ///< bounds of the reflectance at normal incidence of all channels
    F anisotropy = all<N>(0);  ///< strength of anisotropy, which the tables lack
  };
  explicit RefractionLoss(const Boundary& boundary);

  /// The loss for light to or from a direction with |cos(theta)| = z above or below the surface.
  [[nodiscard]] F above(const F& z) const { return at(z, above_is_thinner_); }
  [[nodiscard]] F below(const F& z) const { return at(z, 1 - above_is_thinner_); }

  /// The cosine-weighted means of above() and below().
  [[nodiscard]] F mean_above() const {
    return above_is_thinner_ != 0 ? mean_outside_ : mean_within_;
  }
  [[nodiscard]] F mean_below() const {
    return above_is_thinner_ != 0 ? mean_within_ : mean_outside_;
  }

  /// The fraction of the loss above the surface that multiple scattering transmits. Multiple
  /// scattering reflects the rest.
  [[nodiscard]] const F& through() const { return through_; }

 private:
  static constexpr int kColumns = kLossColumns, kHalf = (kLossColumns + 1) / 2;

  void add(const F& weight, const Int<N>& row);
  [[nodiscard]] F at(const F& z, const F& is_outside) const;

  F above_is_thinner_ = all<N>(1);  // 1 or 0
  F critical_ = all<N>(0.5F);       // cosine of the critical angle
  F outside_[kLossColumns]{}, within_[kLossColumns]{};
  F mean_outside_{}, mean_within_{}, through_{};
};

template <int N>
void RefractionLoss<N>::add(const F& weight, const Int<N>& row) {
  const int first = lane(row, 0);
  // Most surfaces in the lanes are of one material.
  if (!any(row != first)) {
    for (int i = 0; i < kColumns; ++i) {
      outside_[i] += weight * float(kTables.loss_from_outside[first * kColumns + i]);
      within_[i] += weight * float(kTables.loss_from_within[first * kColumns + i]);
    }
    return;
  }
  for (int i = 0; i < kColumns; ++i) {
    outside_[i] += weight * gathered<N>(kTables.loss_from_outside + i, row * kColumns);
    within_[i] += weight * gathered<N>(kTables.loss_from_within + i, row * kColumns);
  }
}

template <int N>
RefractionLoss<N>::RefractionLoss(const Boundary& boundary) {
  const auto& [roughness, eta, dielectric, least_f0, most_f0, anisotropy] = boundary;
  const F zero{}, one = all<N>(1);
  const auto above_is_thinner = eta > 1;
  above_is_thinner_ = above_is_thinner ? one : zero;
  const F q = above_is_thinner ? 1 / eta : eta, r = (1 - q) / (1 + q);
  critical_ = square_root<N>(1 - q * q);
  const Parabola<N> index(smaller_of(critical_ / kGreatestCritical, one), kLossIndices);
  const Parabola<N> row(clamped(roughness, zero, one), kLossRows);
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      const int rows = kLossRows;
      add(index.weights[k] * row.weights[j] * kRefractionUnit,
          (index.first + k) * rows + (row.first + j));
    }
  }
  // The tables assume the reflectance that follows from the index of refraction. If the actual
  // reflectance is f90 times as large, at least this fraction of the loss remains. From the thinner
  // side, microfacets lose more of the light that they reflect than of the light that they
  // transmit, and from the denser side the reverse. Anisotropic microfacets lose more on average,
  // but less in some directions, mainly on the thinner side.
  const F sure = 1 - anisotropy, weight = dielectric.f90 * sure;
  const F assumed = dielectric.f90 * r * r, some = all<N>(0.5F);
  const F unsure_outside = some * larger_of(F(assumed - least_f0), zero);
  const F unsure_within = some * larger_of(F(most_f0 - assumed), zero);
  constexpr auto weights = hat_weights<3, kColumns>();
  constexpr auto cubic = hat_weights<3, kHalf>();
  constexpr auto linear = hat_weights<1, kHalf>();
  for (int i = 0; i < kColumns; ++i) {
    outside_[i] = clamped(F(weight * sure * outside_[i] - unsure_outside), zero, one);
    within_[i] = clamped(F(weight * within_[i] - unsure_within), zero, one);
    mean_outside_ += weights.value[i] * outside_[i];
  }
  const F c = critical_;
  for (int i = 0; i < kHalf; ++i) {
    const F above = 2 * c * linear.value[i] + (1 - c) * cubic.value[i];
    mean_within_ += c * c * cubic.value[i] * within_[i] + (1 - c) * above * within_[i + kHalf - 1];
  }
  mean_outside_ = larger_of(mean_outside_, all<N>(1e-6F));
  mean_within_ = larger_of(mean_within_, all<N>(1e-6F));
  // By reciprocity, through / eta^2 divided by the mean loss of the opposite side is equal for both
  // sides.
  const F fresnel = dielectric.f0 + (dielectric.f90 - dielectric.f0) * (1 / 21.0F);
  const F ratio = eta * eta * mean_below() / mean_above();
  through_ = (1 - fresnel) * smaller_of(one, ratio);
}

template <int N>
auto RefractionLoss<N>::at(const F& z, const F& is_outside) const -> F {
  constexpr auto half = static_cast<float>(kHalf - 1);
  const auto is_totally_reflected = z < critical_;
  const F part = is_totally_reflected ? z / critical_ : (z - critical_) / (1 - critical_);
  const F within = half * square_root<N>(part);
  const auto outside = is_outside != 0;
  const Cell<N> cell(outside                ? square_root<N>(z) * (kColumns - 1)
                     : is_totally_reflected ? within
                                            : half + within,
                     kColumns);
  const F first = outside ? picked<N>(outside_, cell.first) : picked<N>(within_, cell.first);
  const F second =
      outside ? picked<N>(outside_ + 1, cell.first) : picked<N>(within_ + 1, cell.first);
  return cell.mixed(first, second);
}

}  // namespace microtrace::bsdf
