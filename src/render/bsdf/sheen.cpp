#include "render/bsdf/sheen.hpp"

#include "render/bsdf/ggx.hpp"
#include "render/sampling/warps.hpp"
#include "scene/exponential.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace microtrace::bsdf {
namespace {

/// The exponent of the paper's fit of the masking function.
double fit(double x, double alpha) {
  const double t = (1 - alpha) * (1 - alpha);
  const auto mix = [t](double rough, double smooth) { return rough + t * (smooth - rough); };
  const double a = mix(21.5473, 25.3245), b = mix(3.82987, 3.32435), c = mix(0.19823, 0.16801),
               d = mix(-1.97760, -1.27393), e = mix(-4.32054, -4.85967);
  return a / (1 + b * power(x, c)) + d * x + e;
}

}  // namespace

SheenLobe::SheenLobe(float roughness)
    : roughness_(std::clamp(roughness, kLeastSheenRoughness, 1.0F)),
      alpha_(double{roughness_} * roughness_),
      row_(std::sqrt((roughness_ - kLeastSheenRoughness) / (1 - kLeastSheenRoughness)) *
           (kSheenRows - 1)) {}

double SheenLobe::lambda(double cosine) const {
  if (cosine < 0.5) return exponential(fit(cosine, alpha_));
  return exponential(2 * fit(0.5, alpha_) - fit(1 - cosine, alpha_));
}

float SheenLobe::reflectance(const Vec3& wo, const Vec3& wi, const Vec3& h) const {
  const double sine_square = double{h.x} * h.x + double{h.y} * h.y;
  const double d = (2 + 1 / alpha_) * power(std::min(sine_square, 1.0), 0.5 / alpha_) *
                   (0.5 * std::numbers::inv_pi);
  const double masking = 1 + lambda(wo.z) + lambda(wi.z);
  const float most = std::max(look_up(kRawSheenAlbedo, wo.z), look_up(kRawSheenAlbedo, wi.z));
  return static_cast<float>(d / (4 * masking * wo.z * wi.z)) / std::max(most, 1.0F);
}

float SheenLobe::look_up(const SheenTable& table, float z) const {
  const auto place = [](float at, std::size_t steps) {
    const auto first = std::min(static_cast<std::size_t>(at), steps - 2);
    return std::pair(first, at - static_cast<float>(first));
  };
  const float bend = 0.5F * roughness_, height = std::clamp(z, 0.0F, 1.0F);
  const auto [row, down] = place(row_, kSheenRows);
  const auto [column, right] =
      place(height * (1 + bend) / (height + bend) * (kSheenColumns - 1), kSheenColumns);
  const auto in_row = [c = column, r = right](const std::array<float, kSheenColumns>& values) {
    return values[c] + r * (values[c + 1] - values[c]);
  };
  const float upper = in_row(table[row]), lower = in_row(table[row + 1]);
  return upper + down * (lower - upper);
}

// z has the pdf b (1 + b) / (z + b)^2.
Vec3 SheenLobe::direction(const Vec2& u) const {
  const float b = 2 * roughness_, z = std::min(u.y * b / (1 + b - u.y), 1.0F);
  const auto [cosine, sine] = sampling::unit_pair(u.x);
  const float r = std::sqrt(1 - z * z);
  return {r * cosine, r * sine, z};
}

float SheenLobe::pdf(float z) const {
  const float b = 2 * roughness_;
  return 0.5F * kInversePi * b * (1 + b) / ((z + b) * (z + b));
}

}  // namespace microtrace::bsdf
