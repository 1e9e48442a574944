#include "render/lights/map_distribution.hpp"

#include "render/luminance.hpp"
#include "scene/math/revolutions.hpp"
#include "scene/math/trigonometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace microtrace {
namespace {

constexpr std::uint32_t kWhole = 1U << 24U;
/// The minimum probability of a row, and of a cell within its row, relative to the mean. Even with
/// 65537 rows or cells, this minimum exceeds 2^-24.
constexpr double kFloor = 1.0 / 128;

/// Converts weights to cumulative bounds that range from 0 to kWhole.
void accumulate(std::span<const double> weights, double total, std::uint32_t* bounds) {
  double sum = 0;
  *bounds = 0;
  for (const double weight : weights) {
    sum += weight;
    *++bounds = static_cast<std::uint32_t>(std::min(sum / total, 1.0) * kWhole + 0.5);
  }
  *bounds = kWhole;
}

/// Makes the guide table. Entry g of `count` is the index of the last bound that does not exceed g
/// / count, where the search for larger numbers starts.
template <class Index>
void make_guide(std::span<const std::uint32_t> bounds, Index* guide) {
  const std::size_t count = bounds.size() - 1;
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
std::size_t entry_of(std::uint32_t number, std::uint32_t count) {
  return std::uint64_t{number} * count >> 24U;
}

/// Inverts the cumulative distribution of a pdf on [0, 1] that is linear from a to b. u must be
/// positive.
float inverted(float a, float b, float u) {
  const float root = std::sqrt(a * a + u * (b * b - a * a));
  return std::min(u * (a + b) / (a + root), 1.0F);
}

}  // namespace

MapDistribution::MapDistribution(const RadianceMap& map)
    : map_(map),
      width_(map.width),
      height_(map.height),
      rows_(height_ + 1),
      row_bounds_(height_ + 2),
      row_guide_(height_ + 1),
      columns_(std::size_t{height_ + 1} * (width_ + 1)),
      column_guide_(std::size_t{height_ + 1} * width_) {
  const double step = std::numbers::pi / height_;
  const double half = sin_radians(step / 4);
  turns_per_row_ = static_cast<float>(0.5 / height_);
  polar_h_ = static_cast<float>(half * half);
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
  scale_ = mean_luminance_ > 1e-30 ? static_cast<float>(1 / mean_luminance_) : 0;
}

std::vector<double> MapDistribution::make_columns() {
  std::vector<double> row_weights(height_ + 1), cells(width_);
  for (std::uint32_t line = 0; line <= height_; ++line) {
    Row& row = rows_[line];
    row.floor = 0;
    double sum = 0;
    for (std::uint32_t column = 0; column < width_; ++column) {
      const auto w = weights(row, corners_of(map_, {.column = column, .line = line}));
      cells[column] = double{0.25F * ((w[0] + w[1]) + (w[2] + w[3]))};
      sum += cells[column];
    }
    row_weights[line] = sum / width_;
    const double least = sum > 0 ? kFloor * row_weights[line] : 1;
    row.floor = static_cast<float>(least);
    for (double& cell : cells) cell += least;
    std::uint32_t* bounds = &columns_[std::size_t{line} * (width_ + 1)];
    accumulate(cells, sum + least * width_, bounds);
    make_guide({bounds, width_ + 1}, &column_guide_[std::size_t{line} * width_]);
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
  make_guide(row_bounds_, row_guide_.data());
  const double step = std::numbers::pi / height_, wide = 2 * std::numbers::pi / width_;
  const double half = sin_radians(step / 4);
  for (std::uint32_t line = 0; line <= height_; ++line) {
    const double probability = double{1} * (row_bounds_[line + 1] - row_bounds_[line]) / kWhole;
    const double high = is_polar(line) ? 2 * half * half : step;
    rows_[line].pdf = static_cast<float>(probability / (wide * high * kWhole));
  }
}

float MapDistribution::pdf(const MapPlace& place, const std::array<Vec3, 4>& corners,
                           float axis_range) const {
  const Row& row = rows_[place.line];
  const std::uint32_t* bounds = &columns_[std::size_t{place.line} * (width_ + 1) + place.column];
  return pdf(row, bounds[1] - bounds[0], place, weights(row, corners), axis_range);
}

float MapDistribution::pdf(const Row& row, std::uint32_t count, const MapPlace& place,
                           const std::array<float, 4>& w, float axis_range) const {
  const float mean = 0.25F * ((w[0] + w[1]) + (w[2] + w[3]));
  const float cell = static_cast<float>(count) * row.pdf;
  return cell * bilinear(w, place.x, place.y) / (is_polar(place.line) ? mean : mean * axis_range);
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
  return {.index = i, .count = count, .place = offset / static_cast<float>(count)};
}

// Works in steps, each of which prefetches the data of the next step, because the tables and the
// map don't fit into the fastest caches.
void MapDistribution::sample(std::span<const Vec2> u, std::span<Point> points) const {
  std::array<Found, kMostSamples> lines, columns;
  std::array<const std::uint16_t*, kMostSamples> guides;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const std::uint32_t number = number_of(u[i].y);
    lines[i] = find(row_bounds_.data(), row_guide_[entry_of(number, height_ + 1)], number);
    guides[i] =
        &column_guide_[std::size_t{lines[i].index} * width_ + entry_of(number_of(u[i].x), width_)];
    __builtin_prefetch(guides[i]);
  }
  const auto bounds = [&](std::size_t i) {
    return &columns_[std::size_t{lines[i].index} * (width_ + 1)];
  };
  for (std::size_t i = 0; i < u.size(); ++i) __builtin_prefetch(bounds(i) + *guides[i]);
  for (std::size_t i = 0; i < u.size(); ++i) {
    columns[i] = find(bounds(i), *guides[i], number_of(u[i].x));
    for (const Vec3* row : rows_of(map_, lines[i].index))
      __builtin_prefetch(row + columns[i].index);
  }
  for (std::size_t i = 0; i < u.size(); ++i) points[i] = point_in(lines[i], columns[i]);
}

MapDistribution::Point MapDistribution::point_in(const Found& line, const Found& column) const {
  const Row& row = rows_[line.index];
  Point point{.place = {.column = column.index, .line = line.index}};
  const auto w = weights(row, corners_of(map_, point.place));
  const bool is_south = 2 * line.index > height_;
  if (is_polar(line.index)) {
    // Polar cells are uniform in solid angle, so h = (1 - cos(theta)) / 2 is uniform. It is
    // measured from the nearer pole for precision.
    const float h = (is_south ? 1 - line.place : line.place) * polar_h_;
    point.height = 1 - 2 * h;
    point.axis_range = 2 * std::sqrt(h * (1 - h));
    point.place.y = line.place;
  } else {
    const float y = inverted(w[0] + w[1], w[2] + w[3], line.place);
    const auto rows = static_cast<float>(is_south ? height_ - line.index : line.index);
    const float turns = (rows + (is_south ? 0.5F - y : y - 0.5F)) * turns_per_row_;
    const SineCosine angle = sin_cos_revolutions(turns);
    point.height = angle.cosine;
    point.axis_range = angle.sine;
    point.place.y = y;
  }
  if (is_south) point.height = -point.height;
  const float y = point.place.y;
  point.place.x = inverted((1 - y) * w[0] + y * w[2], (1 - y) * w[1] + y * w[3], column.place);
  point.pdf = pdf(row, column.count, point.place, w, point.axis_range);
  return point;
}

}  // namespace microtrace
