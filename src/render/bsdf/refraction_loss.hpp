#pragma once
#include "render/bsdf/anisotropic_ggx.hpp"
#include "render/bsdf/ggx_albedo.hpp"
#include "render/bsdf/tables/tables.hpp"
#include "simd/gather.hpp"

namespace microtrace::bsdf {

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

  /// What the loss depends on.
  struct Boundary {
    F roughness;
    F eta;                          ///< the index of refraction below divided by that above; not 1
    GreatestSchlick<N> dielectric;  ///< the Fresnel term
    F anisotropy = all<N>(0);       ///< strength
    bool has_film = false;          ///< a thin film, with which f0 depends on the angle
  };
  /// Bounds of f0 of all color channels.
  struct F0Range {
    F least, most;
  };
  /// f0_at(cosine) must return the F0Range for this cosine of the angle of incidence in the thinner
  /// medium, on which it depends only if the boundary has a film.
  template <class F0At>
  RefractionLoss(const Boundary& boundary, const F0At& f0_at);

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

  /// An interpolated row of a table.
  struct Row {
    F column[kColumns]{};

    void add(const F& weight, const std::int16_t* table, const Int<N>& row);
  };
  /// The rows for both sides.
  struct Rows {
    Row outside, within;
  };
  /// The place of a boundary in the tables.
  struct Place {
    Parabola<N> index, row;

    [[nodiscard]] Row of(const std::int16_t* table, float unit) const;
  };
  /// The losses of isotropic facets.
  template <class F0At>
  [[nodiscard]] Rows rows_at(const Place& place, const Boundary& boundary, const F0At& f0_at) const;
  /// The cosine of the angle of incidence in the thinner medium for a column, if the facets have
  /// the surface's normal.
  [[nodiscard]] F cosine_outside(int column) const;
  [[nodiscard]] F cosine_within(int column) const;
  /// Replaces the losses of the smaller alpha by losses that anisotropic facets rarely fall below.
  /// rows_of(roughness) must return the losses of isotropic facets.
  template <class RowsOf>
  void limit_anisotropic(const Boundary& boundary, const RowsOf& rows_of);
  void set_means();
  [[nodiscard]] F at(const F& z, const F& is_outside) const;

  F above_is_thinner_ = all<N>(1);  // 1 or 0
  F critical_ = all<N>(0.5F);       // cosine of the critical angle
  Rows rows_;
  F mean_outside_{}, mean_within_{}, through_{};
};

template <int N>
void RefractionLoss<N>::Row::add(const F& weight, const std::int16_t* table, const Int<N>& row) {
  const int first = lane(row, 0);
  // Most surfaces in the lanes are of one material.
  if (!any(row != first)) {
    for (int i = 0; i < kColumns; ++i) column[i] += weight * float(table[first * kColumns + i]);
    return;
  }
  for (int i = 0; i < kColumns; ++i) column[i] += weight * gathered<N>(table + i, row * kColumns);
}

template <int N>
auto RefractionLoss<N>::Place::of(const std::int16_t* table, float unit) const -> Row {
  Row result;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      const int rows = kLossRows;
      result.add(index.weights[k] * row.weights[j] * unit, table,
                 (index.first + k) * rows + (row.first + j));
    }
  }
  return result;
}

template <int N>
auto RefractionLoss<N>::cosine_outside(int column) const -> F {
  const float root = static_cast<float>(column) / (kColumns - 1);
  return all<N>(root * root);
}

template <int N>
auto RefractionLoss<N>::cosine_within(int column) const -> F {
  if (column < kHalf) return F{};
  const float root = static_cast<float>(column - (kHalf - 1)) / (kHalf - 1);
  const F c = critical_, z = c + (1 - c) * (root * root);
  return square_root<N>((z * z - c * c) / (1 - c * c));
}

template <int N>
template <class F0At>
auto RefractionLoss<N>::rows_at(const Place& place, const Boundary& boundary,
                                const F0At& f0_at) const -> Rows {
  Rows rows{place.of(kTables.loss_from_outside, kRefractionUnit),
            place.of(kTables.loss_from_within, kRefractionUnit)};
  // The tables assume f0 = r^2 and f90 = 1. Rounding errors don't count.
  const F r = (boundary.eta - 1) / (boundary.eta + 1), assumed = r * r;
  const auto excess = [](const F& x) { return magnitude(x) < 1e-4F ? F{} : x; };
  const F f90 = excess(boundary.dielectric.f90 - 1);
  const auto f0_excess = [&](const F& cosine) -> F0Range {
    const F0Range f0 = f0_at(cosine);
    return {excess(f0.least - assumed), excess(f0.most - assumed)};
  };
  if (!boundary.has_film) {
    const auto [least, most] = f0_excess(all<N>(1));
    if (!any((least != 0) | (most != 0) | (f90 != 0))) return rows;
  }
  const auto adapt = [&](const F& cosine, const F& by_f0, const F& by_f90, F& loss) {
    constexpr float kError = 0.005F;  // of the derivatives
    const auto [least, most] = f0_excess(cosine);
    const F error = larger_of(magnitude(least), magnitude(most)) + magnitude(f90);
    loss += smaller_of(F(least * by_f0), F(most * by_f0)) + f90 * by_f90 - kError * error;
  };
  const Rows by_f0{place.of(kTables.loss_by_f0_from_outside, kSlopeUnit),
                   place.of(kTables.loss_by_f0_from_within, kSlopeUnit)};
  const Rows by_f90{place.of(kTables.loss_by_f90_from_outside, kSlopeUnit),
                    place.of(kTables.loss_by_f90_from_within, kSlopeUnit)};
  for (int i = 0; i < kColumns; ++i) {
    adapt(cosine_outside(i), by_f0.outside.column[i], by_f90.outside.column[i],
          rows.outside.column[i]);
    adapt(cosine_within(i), by_f0.within.column[i], by_f90.within.column[i], rows.within.column[i]);
  }
  return rows;
}

template <int N>
template <class F0At>
RefractionLoss<N>::RefractionLoss(const Boundary& boundary, const F0At& f0_at) {
  const F &roughness = boundary.roughness, &eta = boundary.eta;
  const GreatestSchlick<N>& dielectric = boundary.dielectric;
  const F zero{}, one = all<N>(1);
  const auto above_is_thinner = eta > 1;
  above_is_thinner_ = above_is_thinner ? one : zero;
  const F q = above_is_thinner ? 1 / eta : eta;
  critical_ = square_root<N>(1 - q * q);
  const Parabola<N> index(smaller_of(critical_ / kGreatestCritical, one), kLossIndices);
  const auto rows_of = [&](const F& rough) {
    return rows_at({index, Parabola<N>(clamped(rough, zero, one), kLossRows)}, boundary, f0_at);
  };
  rows_ = rows_of(roughness);
  if (any(boundary.anisotropy > 0)) limit_anisotropic(boundary, rows_of);
  for (int i = 0; i < kColumns; ++i) {
    rows_.outside.column[i] = clamped(rows_.outside.column[i], zero, one);
    rows_.within.column[i] = clamped(rows_.within.column[i], zero, one);
  }
  set_means();
  // By reciprocity, through / eta^2 divided by the mean loss of the opposite side is equal for both
  // sides.
  const F fresnel = dielectric.f0 + (dielectric.f90 - dielectric.f0) * (1 / 21.0F);
  const F ratio = eta * eta * mean_below() / mean_above();
  through_ = (1 - fresnel) * smaller_of(one, ratio);
}

// The losses of anisotropic facets depend on the azimuth. They are at least about 0.6 times those
// of isotropic facets with the geometric mean of both alphas. Near the horizon, where facets with
// different alphas lose the most, those with the larger alpha may lose less, and so may 1.5 times
// those with the smaller one.
template <int N>
template <class RowsOf>
void RefractionLoss<N>::limit_anisotropic(const Boundary& boundary, const RowsOf& rows_of) {
  const AnisotropicGgx<N> facets(boundary.roughness, boundary.anisotropy, {all<N>(1), F{}});
  const F along = facets.along_alpha(), across = facets.across_alpha();
  const Rows middle = rows_of(square_root<N>(square_root<N>(along * across)));
  const Rows rough = rows_of(square_root<N>(along));
  const F sure = larger_of(F(across / along), all<N>(0.6F));
  const auto limit = [&](const F& middle_loss, const F& rough_loss, F& loss) {
    const F least = smaller_of(smaller_of(middle_loss, rough_loss), F(1.5F * loss));
    loss = boundary.anisotropy > 0 ? F(sure * least) : loss;
  };
  for (int i = 0; i < kColumns; ++i) {
    limit(middle.outside.column[i], rough.outside.column[i], rows_.outside.column[i]);
    limit(middle.within.column[i], rough.within.column[i], rows_.within.column[i]);
  }
}

template <int N>
void RefractionLoss<N>::set_means() {
  constexpr auto weights = hat_weights<3, kColumns>();
  constexpr auto cubic = hat_weights<3, kHalf>();
  constexpr auto linear = hat_weights<1, kHalf>();
  for (int i = 0; i < kColumns; ++i) mean_outside_ += weights.value[i] * rows_.outside.column[i];
  const F c = critical_;
  for (int i = 0; i < kHalf; ++i) {
    const F above = 2 * c * linear.value[i] + (1 - c) * cubic.value[i];
    mean_within_ += c * c * cubic.value[i] * rows_.within.column[i] +
                    (1 - c) * above * rows_.within.column[i + kHalf - 1];
  }
  mean_outside_ = larger_of(mean_outside_, all<N>(1e-6F));
  mean_within_ = larger_of(mean_within_, all<N>(1e-6F));
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
  const F first = outside ? picked<N>(rows_.outside.column, cell.first)
                          : picked<N>(rows_.within.column, cell.first);
  const F second = outside ? picked<N>(rows_.outside.column + 1, cell.first)
                           : picked<N>(rows_.within.column + 1, cell.first);
  return cell.mixed(first, second);
}

}  // namespace microtrace::bsdf
