#include "render/bsdf/refraction_loss.hpp"

#include "render/bsdf/refraction_loss_within_table.hpp"

namespace microtrace::bsdf {
namespace {

/// Lagrange's parabola through three neighboring points out of n in [0, 1].
struct Parabola {
  std::size_t first;
  std::array<float, 3> weights;

  Parabola(float x, std::size_t n) {
    const float step = x * static_cast<float>(n - 1);
    // Not negative, and ties may go either way. NOLINTNEXTLINE(bugprone-incorrect-roundings)
    const auto nearest = static_cast<std::size_t>(step + 0.5F);
    first = std::min(std::max(nearest, std::size_t{1}) - 1, n - 3);
    const float p = step - static_cast<float>(first);
    weights = {(p - 1) * (p - 2) * 0.5F, p * (2 - p), p * (p - 1) * 0.5F};
  }
};

/// Integrals over [0, 1] of (m + 1) x^m times the piecewise linear hat functions of n equidistant
/// points.
template <int m, std::size_t n>
constexpr std::array<float, n> hat_weights() {
  const auto power = [](double x, int k) {
    double result = 1;
    while (k-- > 0) result *= x;
    return result;
  };
  std::array<float, n> result{};
  const double cells = n - 1;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double a = static_cast<double>(i) / cells, b = static_cast<double>(i + 1) / cells;
    const double all = power(b, m + 1) - power(a, m + 1);
    const double moment = (power(b, m + 2) - power(a, m + 2)) * (m + 1) / (m + 2);
    const double upper = (moment - a * all) * cells;
    result[i] += static_cast<float>(all - upper);
    result[i + 1] += static_cast<float>(upper);
  }
  return result;
}

}  // namespace

RefractionLoss::RefractionLoss(float roughness, float eta, const GreatestSchlick& dielectric)
    : above_is_thinner_(eta > 1) {
  const float q = eta > 1 ? 1 / eta : eta, r = (1 - q) / (1 + q);
  critical_ = std::sqrt(1 - q * q);
  const Parabola index(std::min(critical_ / kGreatestCritical, 1.0F), kLossIndices);
  const Parabola row(std::clamp(roughness, 0.0F, 1.0F), kLossRows);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < 3; ++j) {
      const float weight = index.weights[k] * row.weights[j] * kRefractionUnit;
      const auto& out = kLossFromOutside[index.first + k][row.first + j];
      const auto& in = kLossFromWithin[index.first + k][row.first + j];
      for (std::size_t i = 0; i < kLossColumns; ++i) {
        outside_[i] += weight * static_cast<float>(out[i]);
        within_[i] += weight * static_cast<float>(in[i]);
      }
    }
  }
  // The tables use the reflectance that follows from the index. If the actual reflectance is
  // smaller by a factor, at least this fraction of the loss remains; other differences allow no
  // conclusion.
  const float unsure = std::abs(dielectric.f0 - dielectric.f90 * r * r);
  const auto sure = [&](float loss) {
    return std::clamp(dielectric.f90 * loss - unsure, 0.0F, 1.0F);
  };
  constexpr std::size_t half = (kLossColumns + 1) / 2;
  constexpr auto weights = hat_weights<3, kLossColumns>();
  constexpr auto cubic = hat_weights<3, half>();
  constexpr auto linear = hat_weights<1, half>();
  for (std::size_t i = 0; i < kLossColumns; ++i) {
    outside_[i] = sure(outside_[i]);
    within_[i] = sure(within_[i]);
    mean_outside_ += weights[i] * outside_[i];
  }
  const float c = critical_;
  for (std::size_t i = 0; i < half; ++i) {
    const float above = 2 * c * linear[i] + (1 - c) * cubic[i];
    mean_within_ += c * c * cubic[i] * within_[i] + (1 - c) * above * within_[i + half - 1];
  }
  mean_outside_ = std::max(mean_outside_, 1e-6F);
  mean_within_ = std::max(mean_within_, 1e-6F);
  // Reciprocity: through / eta^2 divided by the other side's mean is the same from both sides.
  const float fresnel = dielectric.f0 + (dielectric.f90 - dielectric.f0) * (1 / 21.0F);
  const float ratio = eta * eta * mean_below() / mean_above();
  through_ = (1 - fresnel) * std::min(1.0F, ratio);
}

}  // namespace microtrace::bsdf
