#pragma once
/// Random places in a radiance map, the brighter the likelier.

#include "render/luminance.hpp"

#include <microtrace/environment.hpp>
#include <microtrace/math.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace microtrace {

/// A place between the centres of four pixels of a map. Columns of such cells go around it: column
/// 0 lies between the last pixel's centre and the first one's. Lines 0 and `height` are the halves
/// that are left at the poles.
struct MapPlace {
  std::uint32_t column = 0, line = 0;  ///< below the map's width; at most its height
  float x = 0, y = 0;  ///< in the cell, in [0, 1]; towards the right and the lower edge
};

/// The pixels about a cell: upper left and right, lower left and right.
[[nodiscard]] inline std::array<Vec3, 4> corners_of(const RadianceMap& map, const MapPlace& place) {
  const std::uint32_t left = place.column > 0 ? place.column - 1 : map.width - 1;
  const std::uint32_t above = place.line > 0 ? place.line - 1 : 0;
  const Vec3* upper = &map.pixels[std::size_t{above} * map.width];
  const Vec3* lower = &map.pixels[std::size_t{std::min(place.line, map.height - 1)} * map.width];
  return {upper[left], upper[place.column], lower[left], lower[place.column]};
}

/// Between the corners of a cell.
template <class T>
[[nodiscard]] T bilinear(const std::array<T, 4>& corners, float x, float y) {
  const T high = (1 - x) * corners[0] + x * corners[1];
  const T low = (1 - x) * corners[2] + x * corners[3];
  return (1 - y) * high + y * low;
}

/// The density is bilinear as the map is, but for what the solid angle of a row's pixels changes
/// within it, so that radiance divided by it is smooth about a sun of one pixel too. It follows
/// what a pixel's luminance has beyond the mean of all directions: the rest is found as well by
/// directions that surfaces choose (O. Karlík et al., MIS compensation, 2019). An eighth of the
/// luminance stays for those that choose badly, and a small floor.
///
/// Rows are chosen first, then columns, then the place in the cell, all by inversion: what is well
/// spread in the square is so in the map. Probabilities of cells are multiples of 2^-24, so those
/// of the numbers of 24 bits that fall to a cell are its probability exactly.
class MapDistribution {
 public:
  /// Of luminance below the mean, the part that is sampled.
  static constexpr float kLeastPart = 0.125F;

  /// The map must outlive this.
  explicit MapDistribution(const RadianceMap& map);

  struct Point {
    MapPlace place{};
    float height = 0;      ///< y of the direction
    float axis_range = 0;  ///< distance of the direction from the y axis
    float density = 0;     ///< per steradian
  };
  /// u in [0, 1)^2.
  [[nodiscard]] Point sample(const Vec2& u) const;

  /// Of the direction there, per steradian; the corners are those of the place.
  [[nodiscard]] float density(const MapPlace& place, const std::array<Vec3, 4>& corners,
                              float axis_range) const;

  /// The means of the map's luminance over all directions, and of what is sampled of it.
  [[nodiscard]] double mean_luminance() const { return mean_luminance_; }
  [[nodiscard]] double sampled_luminance() const { return sampled_luminance_; }

 private:
  /// Of cells.
  struct Row {
    std::array<float, 2> sines;  ///< of the angles to the axis at the upper and the lower corners
    float floor;                 ///< of weights
    float density;  ///< of cells for each 2^-24 of their probability in the row; by longitude and
                    ///< angle to the axis, at a pole by solid angle
  };
  [[nodiscard]] bool is_polar(std::uint32_t line) const { return line == 0 || line == height_; }
  /// By solid angle.
  [[nodiscard]] float weight(float luminance) const {
    const float relative = luminance * scale_;
    return std::max(relative - 1, relative * kLeastPart);
  }
  /// At the corners of a cell, by longitude and angle to the axis.
  [[nodiscard]] std::array<float, 4> weights(const Row& row,
                                             const std::array<Vec3, 4>& corners) const {
    std::array<float, 4> result;
    for (std::size_t i = 0; i < 4; ++i)
      result[i] = weight(luminance(corners[i])) * row.sines[i / 2] + row.floor;
    return result;
  }
  [[nodiscard]] float density(const Row& row, std::uint32_t count, const MapPlace& place,
                              const std::array<float, 4>& weights, float axis_range) const;
  void find_mean();
  /// The mean weights of the rows' cells, without floors.
  std::vector<double> make_columns();
  void make_rows(std::vector<double> weights);

  const RadianceMap& map_;
  std::uint32_t width_, height_;
  float turns_per_row_;  ///< of the angle to the axis
  float polar_h_;        ///< (1 - cos(theta)) / 2 where a polar cell ends
  float scale_ = 0;      ///< of luminance, so that its mean is 1
  std::vector<Row> rows_;
  std::vector<std::uint32_t> row_bounds_;  ///< one more than rows, of 0 to 2^24
  std::vector<std::uint32_t> row_guide_;   ///< where to begin the search in row_bounds_
  std::vector<std::uint32_t> columns_;     ///< for each row width + 1 bounds
  std::vector<std::uint16_t> column_guide_;
  double mean_luminance_ = 0, sampled_luminance_ = 0;
};

}  // namespace microtrace
