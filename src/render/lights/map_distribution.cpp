#include "render/lights/map_distribution.hpp"

#include "render/luminance.hpp"
#include "scene/trigonometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace microtrace {
namespace {

constexpr std::uint32_t kWhole = 1U << 24U;
/// The share of the mean probability that the least likely row, and pixel of a row, keep. Where
/// there are 65536 of them that is still more than 2^-24.
constexpr double kFloor = 1.0 / 128;

/// Turns weights into bounds of 0 to kWhole.
void accumulate(std::span<const double> weights, double total, std::uint32_t* bounds) {
  double sum = 0;
  *bounds = 0;
  for (const double weight : weights) {
    sum += weight;
    *++bounds = static_cast<std::uint32_t>(std::min(sum / total, 1.0) * kWhole + 0.5);
  }
  *bounds = kWhole;
}

/// Entry g of count is where the search for g / count begins: at the last bound that is not above.
void make_guide(std::span<const std::uint32_t> bounds, std::uint16_t* guide) {
  const std::size_t count = bounds.size() - 1;
  std::size_t i = 0;
  for (std::size_t g = 0; g < count; ++g) {
    // Numbers that come to entry g are at least this.
    const std::size_t least = (g * kWhole + count - 1) / count;
    while (bounds[i + 1] <= least) ++i;
    guide[g] = static_cast<std::uint16_t>(i);
  }
}

struct Found {
  std::uint32_t index;
  std::uint32_t count;  // of numbers in the cell
  float place;          // in the cell, in (0, 1)
};

Found find(const std::uint32_t* bounds, const std::uint16_t* guide, std::uint32_t cells, float u) {
  const auto number = std::min(static_cast<std::uint32_t>(u * 0x1p24F), kWhole - 1);
  std::uint32_t i = guide[std::uint64_t{number} * cells >> 24U];
  // Mostly two steps at most: taken without branches, which could not be foretold.
  i += std::uint32_t{bounds[i + 1] <= number};
  i += std::uint32_t{bounds[i + 1] <= number};
  while (bounds[i + 1] <= number) ++i;
  const std::uint32_t count = bounds[i + 1] - bounds[i];
  const float offset = static_cast<float>(number - bounds[i]) + 0.5F;
  return {.index = i, .count = count, .place = offset / static_cast<float>(count)};
}

/// (1 - cos(theta)) / 2 at the upper edge of a row.
double edge(std::uint32_t row, std::uint32_t height) {
  const double s = sin_radians(std::numbers::pi / 2 * row / height);
  return s * s;
}

}  // namespace

MapDistribution::MapDistribution(const RadianceMap& map)
    : width_(map.width),
      height_(map.height),
      row_bounds_(height_ + 1),
      row_guide_(height_),
      columns_(std::size_t{height_} * (width_ + 1)),
      column_guide_(std::size_t{height_} * width_) {
  // The mean of a bilinear map over a pixel has weights 1/8, 6/8, 1/8 along each axis.
  const auto pixel_row = [&](std::uint32_t y, std::vector<double>& row) {
    for (std::uint32_t x = 0; x < width_; ++x) {
      row[x] = luminance(DVec3(map.pixels[std::size_t{y} * width_ + x]));
    }
  };
  std::vector<double> above(width_), here(width_), below(width_), mixed(width_), weights(width_);
  std::vector<double> row_sums(height_);
  pixel_row(0, here);
  above = here;
  for (std::uint32_t y = 0; y < height_; ++y) {
    if (y + 1 < height_) pixel_row(y + 1, below);
    if (y + 1 == height_) below = here;
    for (std::uint32_t x = 0; x < width_; ++x) mixed[x] = above[x] + 6 * here[x] + below[x];
    double sum = 0;
    for (std::uint32_t x = 0; x < width_; ++x) {
      const double left = mixed[x > 0 ? x - 1 : width_ - 1];
      const double right = mixed[x + 1 < width_ ? x + 1 : 0];
      weights[x] = (left + 6 * mixed[x] + right) / 64;
      sum += weights[x];
    }
    row_sums[y] = sum;
    const double least = sum > 0 ? kFloor * sum / width_ : 1;
    for (double& weight : weights) weight += least;
    std::uint32_t* bounds = &columns_[std::size_t{y} * (width_ + 1)];
    accumulate(weights, sum + least * width_, bounds);
    make_guide({bounds, width_ + 1}, &column_guide_[std::size_t{y} * width_]);
    std::swap(above, here);
    std::swap(here, below);
  }
  make_rows(row_sums);
}

void MapDistribution::make_rows(const std::vector<double>& row_sums) {
  std::vector<double> weights(height_);
  double sum = 0;
  for (std::uint32_t y = 0; y < height_; ++y) {
    weights[y] = row_sums[y] / width_ * (edge(y + 1, height_) - edge(y, height_));
    sum += weights[y];
  }
  mean_luminance_ = sum;  // the edges' differences sum to 1
  const double least = sum > 0 ? kFloor * sum / height_ : 1;
  for (double& weight : weights) weight += least;
  accumulate(weights, sum + least * height_, row_bounds_.data());
  make_guide(row_bounds_, row_guide_.data());
  rows_.resize(height_);
  for (std::uint32_t y = 0; y < height_; ++y) {
    const bool is_north = 2 * y < height_;
    const double first = is_north ? edge(y, height_) : edge(height_ - y, height_);
    const double last = is_north ? edge(y + 1, height_) : edge(height_ - y - 1, height_);
    const double solid_angle = 4 * std::numbers::pi * std::abs(last - first) / width_;
    const double probability = double{1} * (row_bounds_[y + 1] - row_bounds_[y]) / kWhole;
    rows_[y] = {.first_h = static_cast<float>(first),
                .h_range = static_cast<float>(last - first),
                .pole = is_north ? 1.0F : -1.0F,
                .density = static_cast<float>(probability / (solid_angle * kWhole))};
  }
}

MapDistribution::Point MapDistribution::sample(const Vec2& u) const {
  const Found y = find(row_bounds_.data(), row_guide_.data(), height_, u.y);
  const Found x = find(&columns_[std::size_t{y.index} * (width_ + 1)],
                       &column_guide_[std::size_t{y.index} * width_], width_, u.x);
  const Row& row = rows_[y.index];
  const float h = row.first_h + row.h_range * y.place;
  return {.column = static_cast<float>(x.index) + x.place,
          .height = row.pole * (1 - 2 * h),
          .axis_range = 2 * std::sqrt(h * (1 - h)),
          .density = static_cast<float>(x.count) * row.density};
}

}  // namespace microtrace
