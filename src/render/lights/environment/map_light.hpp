#pragma once
/// Looks up and samples the radiance and the pdf of a map's directions, for N lanes. The pdf is
/// that of MapDistribution.

#include "render/lanes/map_lanes.hpp"
#include "scene/math/luminance.hpp"
#include "simd/revolutions.hpp"

namespace microtrace {

/// The minimum fraction of the luminance that the pdf keeps.
inline constexpr float kLeastMapPart = 0.125F;

/// The weight of a luminance, per solid angle.
template <int N>
Float<N> map_weight(const Float<N>& luminance, float scale) {
  const Float<N> relative = luminance * scale;
  return larger_of(Float<N>(relative - 1), Float<N>(relative * kLeastMapPart));
}

/// Interpolates bilinearly between the corners of a cell.
template <class T, class F>
T bilinear(const T (&corners)[4], const F& x, const F& y) {
  const T high = (1 - x) * corners[0] + x * corners[1];
  const T low = (1 - x) * corners[2] + x * corners[3];
  return (1 - y) * high + y * low;
}

/// Inverts the cumulative distribution of a pdf on [0, 1] that is linear from a to b. u must be
/// positive.
template <int N>
Float<N> inverted_linear(const Float<N>& a, const Float<N>& b, const Float<N>& u) {
  const Float<N> root = square_root<N>(a * a + u * (b * b - a * a));
  return smaller_of(Float<N>(u * (a + b) / (a + root)), all<N>(1));
}

/// The cells of the lanes i to i + N - 1.
template <int N>
struct MapCell {
  using F = Float<N>;
  using Mask = decltype(Int<N>{} == 0);

  Floats3<N> corners[4];
  F weights[4];  ///< of the corners, per unit of longitude and angle to the axis
  F cell_pdf;
  Int<N> line;
  Mask is_polar;

  template <int width>
  MapCell(const MapShape& shape, const MapLanes<width>& lanes, int i) {
    const F floor = load<N>(lanes.floor + i);
    for (int k = 0; k < 4; ++k) {
      corners[k] = load3<N>(lanes.corners[k], i);
      const F weight = map_weight<N>(luminance(corners[k]), shape.weight_scale);
      weights[k] = weight * load<N>(lanes.sines[k / 2] + i) + floor;
    }
    cell_pdf = load<N>(lanes.count + i) * load<N>(lanes.row_pdf + i);
    __builtin_memcpy(&line, lanes.line + i, sizeof line);
    is_polar = (line == 0) | (line == shape.lines);
  }

  /// The pdf per steradian.
  [[nodiscard]] F pdf(const F& x, const F& y, const F& axis_range) const {
    const F mean = 0.25F * ((weights[0] + weights[1]) + (weights[2] + weights[3]));
    return cell_pdf * bilinear(weights, x, y) / (is_polar ? mean : mean * axis_range);
  }
};

template <int N, int width>
void normalize(float (&vectors)[3][width]) {
  for (int i = 0; i < width; i += N) store3<N>(vectors, i, unit<N>(load3<N>(vectors, i)));
}

/// Finds the cells of the directions d. Sets axis_range, column, line, x and y.
template <int N, int width>
void find_map_places(const MapShape& shape, MapLanes<width>& lanes) {
  using F = Float<N>;
  // Clamps to [0, size). NaN gives 0.
  const auto within = [](const F& v, float size, float below) {
    return v >= 0 ? (v < size ? v : all<N>(below)) : F{};
  };
  for (int i = 0; i < width; i += N) {
    const Floats3<N> d = load3<N>(lanes.d, i);
    const F axis_range = square_root<N>(d.x * d.x + d.z * d.z);
    const F turns = atan2_revolutions<N>(d.z, d.x) + (0.5F + shape.turn);  // in [0, 2)
    const F u = turns - chosen<N>(turns >= 1, all<N>(1), F{});
    // In these coordinates, the center of pixel k is at k + 1, which keeps x positive.
    const F x = within(u * shape.width, shape.width, shape.below_width) + 0.5F;
    // atan2 is precise at the poles, unlike acos(y).
    const F v = 2 * shape.height * atan2_revolutions<N>(axis_range, d.y);
    const F y = within(v, shape.height, shape.below_height) + 0.5F;
    const Int<N> whole = truncated<N>(x), line = truncated<N>(y);
    const Int<N> column = whole < shape.columns ? whole : Int<N>{};
    __builtin_memcpy(lanes.column + i, &column, sizeof column);
    __builtin_memcpy(lanes.line + i, &line, sizeof line);
    store<N>(lanes.x + i, x - to_float<N>(whole));
    store<N>(lanes.y + i, y - to_float<N>(line));
    store<N>(lanes.axis_range + i, axis_range);
  }
}

/// Sets the radiance and the pdf.
template <int N, int width>
void look_up_map(const MapShape& shape, MapLanes<width>& lanes) {
  for (int i = 0; i < width; i += N) {
    const MapCell<N> cell(shape, lanes, i);
    const Float<N> x = load<N>(lanes.x + i), y = load<N>(lanes.y + i);
    store3<N>(lanes.radiance, i, shape.intensity * bilinear(cell.corners, x, y));
    store<N>(lanes.pdf + i, cell.pdf(x, y, load<N>(lanes.axis_range + i)));
  }
}

/// Samples directions in the cells. x and y are the positions of random numbers, uniform in (0, 1),
/// and become positions in the cells. Sets d, axis_range, the radiance and the pdf.
template <int N, int width>
void sample_map(const MapShape& shape, MapLanes<width>& lanes) {
  using F = Float<N>;
  for (int i = 0; i < width; i += N) {
    const MapCell<N> cell(shape, lanes, i);
    const auto& w = cell.weights;
    const F u = load<N>(lanes.x + i), v = load<N>(lanes.y + i);
    const auto is_south = 2 * cell.line > shape.lines;
    // Polar cells are uniform in solid angle, so h = (1 - cos(theta)) / 2 is uniform. It is
    // measured from the nearer pole for precision.
    const F h = (is_south ? 1 - v : v) * shape.polar_h;
    const F y = cell.is_polar ? v : inverted_linear<N>(w[0] + w[1], w[2] + w[3], v);
    const F rows = to_float<N>(is_south ? shape.lines - cell.line : cell.line);
    const F turns = (rows + (is_south ? 0.5F - y : y - 0.5F)) * shape.turns_per_row;
    const auto angle = sin_cos_revolutions<N>(turns);
    const F northern = cell.is_polar ? 1 - 2 * h : angle.cosine;
    const F axis_range = cell.is_polar ? 2 * square_root<N>(h * (1 - h)) : angle.sine;
    const F x = inverted_linear<N>((1 - y) * w[0] + y * w[2], (1 - y) * w[1] + y * w[3], u);
    Int<N> column;
    __builtin_memcpy(&column, lanes.column + i, sizeof column);
    F longitude = (to_float<N>(column) + (x - 0.5F)) / shape.width + shape.back_turn;
    longitude -= chosen<N>(longitude >= 1, all<N>(1), F{});
    longitude += chosen<N>(longitude < 0, all<N>(1), F{});
    const auto around = sin_cos_revolutions<N>(longitude);
    store3<N>(
        lanes.d, i,
        {axis_range * around.cosine, is_south ? -northern : northern, axis_range * around.sine});
    store3<N>(lanes.radiance, i, shape.intensity * bilinear(cell.corners, x, y));
    store<N>(lanes.pdf + i, cell.pdf(x, y, axis_range));
    store<N>(lanes.axis_range + i, axis_range);
    store<N>(lanes.x + i, x);
    store<N>(lanes.y + i, y);
  }
}

}  // namespace microtrace
