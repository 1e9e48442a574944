#pragma once
/// Samples points of a radiance map approximately in proportion to luminance.

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
  float x = 0, y = 0;                  ///< position in the cell, in [0, 1], to the right and down
};

/// The first pixels of the rows of pixels at the top and the bottom of a row of cells.
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

/// Interpolates bilinearly between the corners of a cell.
template <class T>
[[nodiscard]] T bilinear(const std::array<T, 4>& corners, float x, float y) {
  const T high = (1 - x) * corners[0] + x * corners[1];
  const T low = (1 - x) * corners[2] + x * corners[3];
  return (1 - y) * high + y * low;
}

/// The pdf of directions. Like the map's radiance, it is bilinear in each cell, except that the
/// solid angle varies within a row. Therefore radiance / pdf is smooth even near a sun of one
/// pixel. The pdf is based on the luminance in excess of the mean over all directions, because BSDF
/// sampling finds the rest equally well (O. Karlík et al., MIS compensation, 2019). An eighth of
/// the luminance is kept as a minimum for surfaces whose BSDF sampling is poor, and each cell has a
/// small minimum probability.
///
/// Sampling selects a row, then a column, then a position in the cell. All three steps invert a
/// cumulative distribution, which preserves the stratification of low-discrepancy points.
/// Probabilities are multiples of 2^-24, so each equals the fraction of 24-bit numbers that select
/// its row or column.
class MapDistribution {
 public:
  /// The minimum fraction of the luminance that the pdf keeps.
  static constexpr float kLeastPart = 0.125F;

  /// The map must outlive this object.
  explicit MapDistribution(const RadianceMap& map);

  struct Point {
    MapPlace place{};
    float height = 0;      ///< y component of the direction
    float axis_range = 0;  ///< distance of the direction's end point from the y axis
    float pdf = 0;         ///< per steradian
  };
  /// Samples up to kMostSamples points, for elements of u in [0, 1)^2. Sampling several at a time
  /// is faster, because their memory accesses overlap.
  static constexpr std::size_t kMostSamples = 16;
  void sample(std::span<const Vec2> u, std::span<Point> points) const;

  /// The pdf of a direction, per steradian. `corners` are those of the cell that contains it.
  [[nodiscard]] float pdf(const MapPlace& place, const std::array<Vec3, 4>& corners,
                          float axis_range) const;

  /// The means over all directions of the map's luminance, and of the part of it on which the pdf
  /// is based.
  [[nodiscard]] double mean_luminance() const { return mean_luminance_; }
  [[nodiscard]] double sampled_luminance() const { return sampled_luminance_; }

 private:
  /// A row of cells.
  struct Row {
    /// Sines of the angles to the y axis at the upper and lower corners.
    std::array<float, 2> sines;
    float floor;  ///< minimum weight
    /// A cell's mean pdf divided by the cell's probability within the row, in units of 2^-24. The
    /// pdf is per longitude and polar angle, but per solid angle in polar rows.
    float pdf;
  };
  [[nodiscard]] bool is_polar(std::uint32_t line) const { return line == 0 || line == height_; }
  /// The weight of a luminance, per solid angle.
  [[nodiscard]] float weight(float luminance) const {
    const float relative = luminance * scale_;
    return std::max(relative - 1, relative * kLeastPart);
  }
  /// The weights at the corners of a cell, per unit of longitude and angle to the axis.
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
    std::uint32_t count;  ///< how many 24-bit numbers select it
    float place;          ///< position in the cell, in (0, 1)
  };
  template <class Index>
  static Found find(const std::uint32_t* bounds, Index start, std::uint32_t number);
  [[nodiscard]] Point point_in(const Found& line, const Found& column) const;
  void find_mean();
  /// Makes the columns' cumulative bounds. Returns the mean weight of each row's cells, without
  /// minimum probabilities.
  std::vector<double> make_columns();
  void make_rows(std::vector<double> weights);

  const RadianceMap& map_;
  std::uint32_t width_, height_;
  float turns_per_row_;  ///< height of a row of cells as an angle, in revolutions
  float polar_h_;        ///< (1 - cos(theta)) / 2 at the end of a polar cell
  float scale_ = 0;      ///< scales luminance to a mean of 1
  std::vector<Row> rows_;
  std::vector<std::uint32_t> row_bounds_;  ///< cumulative bounds from 0 to 2^24, one more than rows
  std::vector<std::uint32_t> row_guide_;   ///< where the search in row_bounds_ starts
  std::vector<std::uint32_t> columns_;     ///< width + 1 cumulative bounds for each row
  std::vector<std::uint16_t> column_guide_;
  double mean_luminance_ = 0, sampled_luminance_ = 0;
};

}  // namespace microtrace
