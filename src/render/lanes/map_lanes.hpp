#pragma once
/// Input and output of the kernels for radiance maps. Contains only plain data; see
/// shading_kernels.hpp.

#include <cstdint>

namespace microtrace {

/// A radiance map and its rotation.
struct MapShape {
  float width, height;              ///< in pixels
  float below_width, below_height;  ///< the next smaller numbers
  std::int32_t columns, lines;      ///< width and height as integers
  float turn;                       ///< added to a direction's longitude, in [0, 1) revolutions
  float back_turn;      ///< added to the map's u to get a longitude, in [0, 1) revolutions
  float intensity;      ///< factor of the map's radiance
  float turns_per_row;  ///< height of a row of cells as an angle, in revolutions
  float polar_h;        ///< (1 - cos(theta)) / 2 at the end of a polar cell
  float weight_scale;   ///< scales the map's luminance to a mean of 1; see MapDistribution
};

/// Directions, and the cells between the centers of four pixels of a map in which they lie. Cells
/// wrap around: column 0 is between the centers of the last and the first pixel. Lines 0 and
/// `lines` are the half cells at the poles.
template <int width>
struct alignas(width * sizeof(float)) MapLanes {
  using Floats = float[width];

  Floats d[3];        ///< approximately of unit length
  Floats axis_range;  ///< distance of the direction's end point from the y axis
  std::int32_t column[width], line[width];
  Floats x, y;  ///< position in the cell, in [0, 1], to the right and down
  /// The radiance at the cell's corners: upper left and right, lower left and right.
  Floats corners[4][3];
  // The cell's entries in MapDistribution.
  Floats sines[2], floor, row_pdf, count;
  // The kernels set the members below.
  Floats radiance[3], pdf;
};

}  // namespace microtrace
