#pragma once
/// Samples points of a radiance map in proportion to luminance.

#include "render/luminance.hpp"

#include <microtrace/environment.hpp>
#include <microtrace/math.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace microtrace {

/// A position in the cell between the centers of four pixels of a map. Cells wrap around: column 0
/// is between the centers of the last and the first pixel. Lines 0 and `height` are the half cells
/// at the poles.
struct MapPlace {
  std::uint32_t column = 0, line = 0;  ///< less than the map's width; at most its height
  float x = 0, y = 0;                  ///< in the cell, in [0, 1]; to the right and down
};

/// The first pixels of the rows at the upper and lower corners of a cell.
[[nodiscard]] inline std::array<const Vec3*, 2> rows_of(const RadianceMap& map,
                                                        std::uint32_t line) {
  const std::uint32_t above = line > 0 ? line - 1 : 0, below = std::min(line, map.height - 1);
  return {&map.pixels[std::size_t{above} * map.width], &map.pixels[std::size_t{below} * map.width]};
}

/// The pixels at a cell's corners: upper left and right, lower left and right.
[[nodiscard]] inline std::array<Vec3, 4> corners_of(const RadianceMap& map, const MapPlace& place) {
  const std::uint32_t left = place.column > 0 ? place.column - 1 : map.width - 1;
  const auto [upper, lower] = rows_of(map, place.line);
  return {upper[left], upper[place.column], lower[left], lower[place.column]};
}

/// Bilinear interpolation between the corners of a cell.
template <class T>
[[nodiscard]] T bilinear(const std::array<T, 4>& corners, float x, float y) {
  const T high = (1 - x) * corners[0] + x * corners[1];
  const T low = (1 - x) * corners[2] + x * corners[3];
  return (1 - y) * high + y * low;
}

/// The pdf is bilinear like the map, except that the solid angle varies within a row, so radiance /
/// pdf is smooth even near a sun of one pixel. The pdf follows the luminance above the mean of all
/// directions, because BSDF sampling finds the rest as well (O. Karlík et al., MIS compensation,
/// 2019). An eighth of the luminance below the mean remains, for surfaces whose BSDF sampling is
/// poor, and a small minimum.
///
/// Rows are sampled first, then columns, then positions in the cell, all by inversion, which
/// preserves the distribution of low-discrepancy points. Probabilities of cells are multiples of
/// 2^-24, so a cell's probability is exactly the fraction of 24-bit numbers that select it.
class MapDistribution {
 public:
  /// The fraction of the luminance below the mean that is sampled.
  static constexpr float kLeastPart = 0.125F;

  /// The map must outlive this object.
  explicit MapDistribution(const RadianceMap& map);

  struct Point {
    MapPlace place{};
    float height = 0;      ///< y of the direction
    float axis_range = 0;  ///< distance of the direction from the y axis
    float pdf = 0;         ///< per steradian
  };
  /// Takes up to kMostSamples of u, each in [0, 1)^2. Several are faster than one at a time,
  /// because their memory accesses overlap.
  static constexpr std::size_t kMostSamples = 16;
  void sample(std::span<const Vec2> u, std::span<Point> points) const;

  /// The pdf of a direction, per steradian. `corners` are those of the cell that contains it.
  [[nodiscard]] float pdf(const MapPlace& place, const std::array<Vec3, 4>& corners,
                          float axis_range) const;

  /// The means over all directions of the map's luminance, and of the part that is sampled.
  [[nodiscard]] double mean_luminance() const { return mean_luminance_; }
  [[nodiscard]] double sampled_luminance() const { return sampled_luminance_; }

 private:
  /// A row of cells.
  struct Row {
    std::array<float, 2> sines;  ///< sines of the angles to the axis at the upper and lower corners
    float floor;                 ///< minimum weight
    float pdf;  ///< pdf of a cell per 2^-24 of its probability in the row: by longitude and angle
                ///< to the axis; at the poles by solid angle
  };
  [[nodiscard]] bool is_polar(std::uint32_t line) const { return line == 0 || line == height_; }
  /// The weight per solid angle.
  [[nodiscard]] float weight(float luminance) const {
    const float relative = luminance * scale_;
    return std::max(relative - 1, relative * kLeastPart);
  }
  /// Weights at the corners of a cell, by longitude and angle to the axis.
  [[nodiscard]] std::array<float, 4> weights(const Row& row,
                                             const std::array<Vec3, 4>& corners) const {
    std::array<float, 4> result;
    for (std::size_t i = 0; i < 4; ++i)
      result[i] = weight(luminance(corners[i])) * row.sines[i / 2] + row.floor;
    return result;
  }
  [[nodiscard]] float pdf(const Row& row, std::uint32_t count, const MapPlace& place,
                          const std::array<float, 4>& weights, float axis_range) const;
  /// A selected row or column.
  struct Found {
    std::uint32_t index;
    std::uint32_t count;  ///< numbers that select the cell
    float place;          ///< position in the cell, in (0, 1)
  };
  template <class Index>
  static Found find(const std::uint32_t* bounds, Index start, std::uint32_t number);
  [[nodiscard]] Point point_in(const Found& line, const Found& column) const;
  void find_mean();
  /// The mean weights of the cells of each row, without minimum probabilities.
  std::vector<double> make_columns();
  void make_rows(std::vector<double> weights);

  const RadianceMap& map_;
  std::uint32_t width_, height_;
  float turns_per_row_;  ///< revolutions of the angle to the axis
  float polar_h_;        ///< (1 - cos(theta)) / 2 at the end of a polar cell
  float scale_ = 0;      ///< scales luminance to a mean of 1
  std::vector<Row> rows_;
  std::vector<std::uint32_t> row_bounds_;  ///< cumulative, number of rows + 1, from 0 to 2^24
  std::vector<std::uint32_t> row_guide_;   ///< start of the search in row_bounds_
  std::vector<std::uint32_t> columns_;     ///< width + 1 cumulative bounds for each row
  std::vector<std::uint16_t> column_guide_;
  double mean_luminance_ = 0, sampled_luminance_ = 0;
};

}  // namespace microtrace
