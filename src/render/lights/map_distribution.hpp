#pragma once
/// Random pixels of a radiance map, the brighter the likelier.

#include <microtrace/environment.hpp>
#include <microtrace/math.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace microtrace {

/// The density is constant within a pixel: proportional to the mean of the bilinear map's luminance
/// over the pixel, on top of a small floor, so that no light is left out or too unlikely. Rows are
/// chosen first, then columns, both by inversion: what is well spread in the square is so among the
/// pixels. Probabilities are multiples of 2^-24, so those of the numbers of 24 bits that fall to a
/// pixel are its probability exactly.
class MapDistribution {
 public:
  explicit MapDistribution(const RadianceMap& map);

  struct Point {
    float column;      ///< in pixels, in [0, width]
    float height;      ///< y of the direction
    float axis_range;  ///< distance of the direction from the y axis
    float density;     ///< of the pixel that was chosen
  };
  /// u in [0, 1)^2.
  [[nodiscard]] Point sample(const Vec2& u) const;

  /// Of directions in the pixel, per steradian.
  [[nodiscard]] float density(std::uint32_t x, std::uint32_t y) const {
    const std::uint32_t* bounds = &columns_[std::size_t{y} * (width_ + 1) + x];
    return static_cast<float>(bounds[1] - bounds[0]) * rows_[y].density;
  }

  /// The mean of the map's luminance over all directions.
  [[nodiscard]] double mean_luminance() const { return mean_luminance_; }

 private:
  /// h = (1 -+ cos(theta)) / 2 is uniform in solid angle, and precise at the pole that it is
  /// measured from.
  struct Row {
    float first_h, h_range;
    float pole;     ///< y of the pole that h is measured from: 1 or -1
    float density;  ///< of the row's columns, for each 2^-24 of their probability
  };
  void make_rows(const std::vector<double>& row_sums);

  std::uint32_t width_, height_;
  std::vector<Row> rows_;
  std::vector<std::uint32_t> row_bounds_;  ///< height + 1 of 0 to 2^24
  std::vector<std::uint16_t> row_guide_;   ///< where to begin the search in row_bounds_
  std::vector<std::uint32_t> columns_;     ///< for each row width + 1 bounds
  std::vector<std::uint16_t> column_guide_;
  double mean_luminance_ = 0;
};

}  // namespace microtrace
