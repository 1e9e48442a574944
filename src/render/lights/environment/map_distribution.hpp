#pragma once
/// Samples points of a radiance map approximately in proportion to luminance.

#include "render/lanes/lane_access.hpp"
#include "render/lanes/shading_kernels.hpp"
#include "simd/vector_types.hpp"

#include <microtrace/environment.hpp>
#include <microtrace/math.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace microtrace {

/// The first pixels of the rows of pixels at the top and the bottom of a row of cells.
[[nodiscard]] inline std::array<const Vec3*, 2> rows_of(const RadianceMap& map,
                                                        std::uint32_t line) {
  const std::uint32_t above = line > 0 ? line - 1 : 0, below = std::min(line, map.height - 1);
  return {&map.pixels[std::size_t{above} * map.width], &map.pixels[std::size_t{below} * map.width]};
}

/// The pixels at a cell's corners: upper left and right, lower left and right.
[[nodiscard]] inline std::array<Vec3, 4> corners_of(const RadianceMap& map, std::uint32_t column,
                                                    std::uint32_t line) {
  const std::uint32_t left = column > 0 ? column - 1 : map.width - 1;
  const auto [upper, lower] = rows_of(map, line);
  return {upper[left], upper[column], lower[left], lower[column]};
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
  /// The map must outlive this object.
  explicit MapDistribution(const RadianceMap& map);

  /// The shape of the map without a rotation, with an intensity of 1.
  [[nodiscard]] const MapShape& shape() const { return shape_; }

  /// Selects a cell for u in [0, 1)^2 in each of these lanes. Sets all members that sample_map()
  /// reads. Selecting several at a time is faster, because their memory accesses overlap.
  void select(Lanes which, const LaneFloats (&u)[2], MapLanes<kShadingLanes>& lanes) const;

  /// Prefetches what put_cell() reads.
  void prefetch(std::uint32_t column, std::uint32_t line) const;
  /// Sets the corners of a lane's cell and its entries in the distribution.
  template <int width>
  void put_cell(int lane, MapLanes<width>& lanes) const {
    const auto column = static_cast<std::uint32_t>(lanes.column[lane]);
    const auto line = static_cast<std::uint32_t>(lanes.line[lane]);
    const auto corners = corners_of(map_, column, line);
    for (std::size_t i = 0; i < 4; ++i) put(lanes.corners[i], lane, corners[i]);
    const Row& row = rows_[line];
    lanes.sines[0][lane] = row.sines[0];
    lanes.sines[1][lane] = row.sines[1];
    lanes.floor[lane] = row.floor;
    lanes.row_pdf[lane] = row.pdf;
    const std::uint32_t* bounds = columns_of(line) + column;
    lanes.count[lane] = static_cast<float>(bounds[1] - bounds[0]);
  }

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
  [[nodiscard]] const std::uint32_t* columns_of(std::uint32_t line) const {
    return &columns_[std::size_t{line} * (width_ + 1)];
  }
  /// A selected row or column.
  struct Found {
    std::uint32_t index;
    float place;  ///< position in the cell, in (0, 1)
  };
  template <class Index>
  static Found find(const std::uint32_t* bounds, Index start, std::uint32_t number);
  void find_mean();
  /// Makes the columns' cumulative bounds. Returns the mean weight of each row's cells, without
  /// minimum probabilities.
  std::vector<double> make_columns();
  void make_rows(std::vector<double> weights);

  const RadianceMap& map_;
  std::uint32_t width_, height_;
  MapShape shape_{};
  std::vector<Row> rows_;
  std::vector<std::uint32_t> row_bounds_;  ///< cumulative bounds from 0 to 2^24, one more than rows
  std::vector<std::uint32_t> row_guide_;   ///< where the search in row_bounds_ starts
  std::vector<std::uint32_t> columns_;     ///< width + 1 cumulative bounds for each row
  std::vector<std::uint16_t> column_guide_;
  double mean_luminance_ = 0, sampled_luminance_ = 0;
};

}  // namespace microtrace
