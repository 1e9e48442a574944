#include "render/lights/environment/map_distribution.hpp"

#include "render/lights/environment/map_light.hpp"
#include "scene/math/luminance.hpp"
#include "scene/math/trigonometry.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>

namespace microtrace {
namespace {

constexpr std::uint32_t kWhole = 1U << 24U;
/// The minimum probability of a row, and of a cell within its row, relative to the mean. Even with
/// 65537 rows or cells, this minimum exceeds 2^-24.
constexpr double kFloor = 1.0 / 128;
/// The number of entries of the rows' guide per row. More than one, because the rows of a sun use
/// most of them.
constexpr std::uint32_t kGuidesPerRow = 8;

/// Converts weights to cumulative bounds that range from 0 to kWhole.
void accumulate(std::span<const double> weights, double total, std::uint32_t* bounds) {
  double sum = 0;
  *bounds = 0;
  for (const double weight : weights) {
    sum += weight;
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): positive, and faster than std::lround
    *++bounds = static_cast<std::uint32_t>(std::min(sum / total, 1.0) * kWhole + 0.5);
  }
  *bounds = kWhole;
}

/// Fills a guide table. Entry g of `count` is the index of the last bound that does not exceed g /
/// count, where the search for larger numbers starts.
template <class Index>
void fill_guide(std::span<const std::uint32_t> bounds, std::span<Index> guide) {
  const std::size_t count = guide.size();
  std::size_t i = 0;
  for (std::size_t g = 0; g < count; ++g) {
    // The least number for which entry g is used.
    const std::size_t least = (g * kWhole + count - 1) / count;
    while (bounds[i + 1] <= least) ++i;
    guide[g] = static_cast<Index>(i);
  }
}

/// Converts u to a 24-bit number.
std::uint32_t number_of(float u) {
  return std::min(static_cast<std::uint32_t>(u * 0x1p24F), kWhole - 1);
}

/// The index of the entry for a number in a guide with `count` entries.
std::size_t entry_of(std::uint32_t number, std::size_t count) {
  return std::uint64_t{number} * count >> 24U;
}

}  // namespace

MapDistribution::MapDistribution(const RadianceMap& map)
    : map_(map),
      width_(map.width),
      height_(map.height),
      rows_(height_ + 1),
      row_bounds_(height_ + 2),
      row_guide_(std::size_t{kGuidesPerRow} * (height_ + 1)),
      columns_(std::size_t{height_ + 1} * (width_ + 1)),
      column_guide_(std::size_t{height_ + 1} * width_) {
  const double step = std::numbers::pi / height_;
  const double half = sin_radians(step / 4);
  const auto width = static_cast<float>(width_), height = static_cast<float>(height_);
  shape_ = {.width = width,
            .height = height,
            .below_width = std::nextafter(width, 0.0F),
            .below_height = std::nextafter(height, 0.0F),
            .columns = static_cast<std::int32_t>(width_),
            .lines = static_cast<std::int32_t>(height_),
            .turn = 0,
            .back_turn = 0.5F,
            .intensity = 1,
            .turns_per_row = static_cast<float>(0.5 / height_),
            .polar_h = static_cast<float>(half * half),
            .weight_scale = 0};
  for (std::uint32_t line = 0; line <= height_; ++line) {
    const auto sine = [&](double y) { return static_cast<float>(sin_radians(step * y)); };
    rows_[line].sines = {sine(line - 0.5), sine(height_ - line - 0.5)};
    // Makes the weights of polar rows proportional to solid angle, like those of other rows.
    if (is_polar(line)) rows_[line].sines.fill(static_cast<float>(2 * half * half / step));
  }
  find_mean();
  make_rows(make_columns());
}

void MapDistribution::find_mean() {
  const double step = std::numbers::pi / height_;
  double sum = 0, above = 0, below = 0;
  for (std::uint32_t line = 0; line <= height_; ++line) {
    if (line < height_) {
      above = below;
      below = 0;
      for (const Vec3& pixel : std::span(map_.pixels).subspan(std::size_t{line} * width_, width_))
        below += luminance(DVec3(pixel));
    }
    // `all` is the integral of the sine over the row of cells, and `lower` the integral of the sine
    // times the weight of the lower pixels.
    const double top = step * std::max(line - 0.5, 0.0);
    const double bottom = step * std::min(line + 0.5, double{1} * height_);
    const double all = cos_radians(top) - cos_radians(bottom);
    double lower = (sin_radians(bottom) - sin_radians(top)) / step - cos_radians(bottom);
    if (is_polar(line)) lower = all;
    sum += lower * below + (all - lower) * above;
  }
  mean_luminance_ = sum / (2 * width_);
  // Treats smaller means as 0, because their inverses might exceed the range of float.
  shape_.weight_scale = mean_luminance_ > 1e-30 ? static_cast<float>(1 / mean_luminance_) : 0;
}

std::vector<double> MapDistribution::make_columns() {
  std::vector<double> row_weights(height_ + 1), cells(width_);
  for (std::uint32_t line = 0; line <= height_; ++line) {
    Row& row = rows_[line];
    row.floor = 0;
    double sum = 0;
    for (std::uint32_t column = 0; column < width_; ++column) {
      const auto corners = corners_of(map_, column, line);
      const auto weight = [&](std::size_t i) {
        return map_weight<1>(luminance(corners[i]), shape_.weight_scale) * row.sines[i / 2];
      };
      cells[column] = double{0.25F * ((weight(0) + weight(1)) + (weight(2) + weight(3)))};
      sum += cells[column];
    }
    row_weights[line] = sum / width_;
    const double least = sum > 0 ? kFloor * row_weights[line] : 1;
    row.floor = static_cast<float>(least);
    for (double& cell : cells) cell += least;
    std::uint32_t* bounds = &columns_[std::size_t{line} * (width_ + 1)];
    accumulate(cells, sum + least * width_, bounds);
    fill_guide({bounds, width_ + 1},
               std::span(column_guide_).subspan(std::size_t{line} * width_, width_));
  }
  return row_weights;
}

void MapDistribution::make_rows(std::vector<double> weights) {
  double sum = 0, solid_angle = 0;
  for (std::uint32_t line = 0; line <= height_; ++line) {
    sum += weights[line];
    solid_angle += (double{rows_[line].sines[0]} + double{rows_[line].sines[1]}) / 2;
  }
  sampled_luminance_ = mean_luminance_ * sum / solid_angle;
  const double least = sum > 0 ? kFloor * sum / (height_ + 1) : 1;
  for (double& weight : weights) weight += least;
  accumulate(weights, sum + least * (height_ + 1), row_bounds_.data());
  fill_guide(row_bounds_, std::span(row_guide_));
  const double step = std::numbers::pi / height_, wide = 2 * std::numbers::pi / width_;
  const double half = sin_radians(step / 4);
  for (std::uint32_t line = 0; line <= height_; ++line) {
    const double probability = double{1} * (row_bounds_[line + 1] - row_bounds_[line]) / kWhole;
    const double high = is_polar(line) ? 2 * half * half : step;
    rows_[line].pdf = static_cast<float>(probability / (wide * high * kWhole));
  }
}

template <class Index>
MapDistribution::Found MapDistribution::find(const std::uint32_t* bounds, Index start,
                                             std::uint32_t number) {
  std::uint32_t i = start;
  // Usually, at most two steps are needed. They are done without branches, which would be
  // unpredictable.
  i += std::uint32_t{bounds[i + 1] <= number};
  i += std::uint32_t{bounds[i + 1] <= number};
  while (bounds[i + 1] <= number) ++i;
  const std::uint32_t count = bounds[i + 1] - bounds[i];
  const float offset = static_cast<float>(number - bounds[i]) + 0.5F;
  return {.index = i, .place = offset / static_cast<float>(count)};
}

void MapDistribution::prefetch(std::uint32_t column, std::uint32_t line) const {
  for (const Vec3* row : rows_of(map_, line)) __builtin_prefetch(row + column);
  __builtin_prefetch(columns_of(line) + column);
}

// Works in steps, each of which prefetches the data of the next step, because the tables and the
// map don't fit into the fastest caches.
void MapDistribution::select(Lanes which, const LaneFloats (&u)[2],
                             MapLanes<kShadingLanes>& lanes) const {
  const auto for_each = [&](const auto& f) {
    for (Lanes rest = which; rest != 0; rest &= rest - 1) f(std::countr_zero(rest));
  };
  const std::uint16_t* guides[kShadingLanes];
  const auto line_of = [&](int i) { return static_cast<std::uint32_t>(lanes.line[i]); };
  for_each([&](int i) {
    const std::uint32_t number = number_of(u[1][i]);
    const std::uint32_t guide = row_guide_[entry_of(number, row_guide_.size())];
    const Found line = find(row_bounds_.data(), guide, number);
    lanes.line[i] = static_cast<std::int32_t>(line.index);
    lanes.y[i] = line.place;
    guides[i] =
        &column_guide_[std::size_t{line.index} * width_ + entry_of(number_of(u[0][i]), width_)];
    __builtin_prefetch(guides[i]);
  });
  for_each([&](int i) { __builtin_prefetch(columns_of(line_of(i)) + *guides[i]); });
  for_each([&](int i) {
    const Found column = find(columns_of(line_of(i)), *guides[i], number_of(u[0][i]));
    lanes.column[i] = static_cast<std::int32_t>(column.index);
    lanes.x[i] = column.place;
    for (const Vec3* row : rows_of(map_, line_of(i))) __builtin_prefetch(row + column.index);
  });
  for_each([&](int i) { put_cell(i, lanes); });
}

}  // namespace microtrace
