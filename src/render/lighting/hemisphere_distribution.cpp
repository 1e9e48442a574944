#include "render/lighting/hemisphere_distribution.hpp"

#include "scene/math/luminance.hpp"
#include "scene/math/revolutions.hpp"
#include "scene/math/trigonometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace microtrace {
namespace {

/// Returns the unit direction at this polar angle, given by the square of its sine, and longitude.
Vec3 direction(float squared_sine, float revolutions) {
  const float r = std::sqrt(squared_sine);
  const SineCosine angle = sin_cos_revolutions(revolutions);
  return {r * angle.cosine, std::sqrt(1 - squared_sine), r * angle.sine};
}

/// Returns the position between two bounds.
float part(double value, double low, double high) {
  return static_cast<float>(std::clamp((value - low) / (high - low), 0.0, 1.0));
}

}  // namespace

HemisphereDistribution::HemisphereDistribution(const EnvironmentLight& light)
    : columns_(light.map_size().width),
      rows_((light.map_size().height + 1) / 2),
      memory_(temporary_memory(std::uint64_t{columns_} * rows_ * sizeof(float),
                               "the sampling table of the ground")),
      bounds_(std::size_t{rows_} + 1),
      row_ends_(rows_),
      column_ends_(std::size_t{columns_} * rows_) {
  for (std::uint32_t row = 1; row < rows_; ++row) {
    const double sine = sin_radians(row * std::numbers::pi / (2.0 * rows_));
    bounds_[row] = static_cast<float>(sine * sine);
  }
  bounds_[rows_] = 1;
  double sum = 0;
  std::vector<double> ends(columns_);
  for (std::uint32_t row = 0; row < rows_; ++row) {
    const double middle = sin_radians((row + 0.5) * std::numbers::pi / (2.0 * rows_));
    double own = 0;
    for (std::uint32_t column = 0; column < columns_; ++column) {
      const float turns = (static_cast<float>(column) + 0.5F) / static_cast<float>(columns_);
      own +=
          double{luminance(light.radiance(direction(static_cast<float>(middle * middle), turns)))};
      ends[column] = own;
    }
    float* const row_of_ends = &column_ends_[std::size_t{row} * columns_];
    for (std::uint32_t column = 0; column < columns_ && own > 0; ++column)
      row_of_ends[column] = static_cast<float>(ends[column] / own);
    sum += own / columns_ * double{bounds_[row + 1] - bounds_[row]};
    row_ends_[row] = sum;
  }
}

Vec3 HemisphereDistribution::sample(const Vec2& u) const {
  const double target = double{u.y} * irradiance();
  const auto row_end = std::ranges::upper_bound(row_ends_, target);
  const auto row = static_cast<std::size_t>(row_end - row_ends_.begin());
  const float v = part(target, row > 0 ? row_ends_[row - 1] : 0, *row_end);

  const auto first = column_ends_.begin() + static_cast<std::ptrdiff_t>(row * columns_);
  const auto end = std::upper_bound(first, first + static_cast<std::ptrdiff_t>(columns_), u.x);
  const float x = part(u.x, end == first ? 0 : *(end - 1), *end);
  const float turns = (static_cast<float>(end - first) + x) / static_cast<float>(columns_);
  return direction(bounds_[row] + v * (bounds_[row + 1] - bounds_[row]), std::min(turns, 1.0F));
}

}  // namespace microtrace
