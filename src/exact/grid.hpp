#pragma once
/// Exact queries about triangles in fixed-width integers, for coordinates on a common grid. The
/// coordinates of nearly all scenes fit on such a grid.
///
/// Represents float32 vectors as integer multiples of a power of two; a float32 number is a 24-bit
/// integer times a power of two. With two limbs, the coordinates of a query may differ by a factor
/// of 2^80, such as 500 and 1e-17, which a rotation may leave instead of 0. With three limbs they
/// may differ by a factor of 2^144, such as 10^8 and the least float32 number, 1e-45. Rays that
/// leave a wall at coordinate 0 may start at such a coordinate.

#include "exact/flat.hpp"
#include "exact/numbers/integer.hpp"

#include <microtrace/math.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <compare>
#include <initializer_list>
#include <optional>

namespace microtrace::exact {

template <int Limbs>
class Grid {
 public:
  using GridVector = VectorOf<Integer<Limbs>>;
  using GridCorners = CornersOf<Integer<Limbs>>;

  /// Chooses the finest grid that can represent components up to 2^spare times the largest
  /// component of these vectors.
  Grid(std::initializer_list<Vec3> vectors, int spare);

  /// The unit of the grid is 2^exponent().
  [[nodiscard]] int exponent() const { return exponent_; }

  /// Returns a vector in units of the grid. Returns nothing if a component is not a multiple of the
  /// unit, is too large, or is not finite.
  [[nodiscard]] std::optional<GridVector> operator()(const Vec3& v) const;
  /// Returns a triangle's vertices relative to `from` in units of the grid, or nothing if the grid
  /// can't represent them.
  [[nodiscard]] std::optional<GridCorners> operator()(const Triangle& t,
                                                      const GridVector& from) const;

 private:
  int exponent_;
};

/// Queries about a triangle's plane.
template <int Limbs>
class GridPlane {
 public:
  explicit GridPlane(const Triangle& triangle);

  // All functions return nothing if the grid can't represent the numbers they need.

  /// Returns the side of the plane on which q is: the sign of (b - a) x (c - a) . (q - a).
  [[nodiscard]] std::optional<int> side(const Vec3& q) const;
  /// Returns the sign of (b - a) x (c - a) . e.
  [[nodiscard]] std::optional<int> slope(const Vec3& e) const;
  /// Returns (b - a) x (c - a), rounded to float64.
  [[nodiscard]] std::optional<DVec3> normal() const;
  [[nodiscard]] std::optional<bool> has_area() const;

 private:
  Grid<Limbs> grid_;
  VectorOf<Integer<Limbs>> a_{};
  std::optional<VectorOf<Integer<2 * Limbs>>> normal_;
};

enum class Found { unknown, miss, hit };

/// Queries about the hit of a ray with a triangle.
template <int Limbs>
class GridHit {
 public:
  GridHit(const Triangle& triangle, const Ray& ray);

  [[nodiscard]] Found found() const { return found_; }

  // The following queries require found() == Found::hit. They return nothing if the grid can't
  // represent the numbers that they need.

  /// Returns bounds of the hit's t.
  [[nodiscard]] const Enclosure& bounds() const { return bounds_; }
  /// Returns t rounded to the nearest float32.
  [[nodiscard]] std::optional<float> t() const;
  /// Returns o + t d with each coordinate rounded to the nearest float32.
  [[nodiscard]] std::optional<Vec3> point() const;
  /// Compares t with the t of the ray's hit with another triangle, which must exist.
  [[nodiscard]] std::optional<std::strong_ordering> order(const Triangle& other) const;
  /// Returns the side of another triangle's plane on which the hit point o + t d is.
  [[nodiscard]] std::optional<int> side(const Triangle& other) const;
  /// See exact::meets_segment().
  [[nodiscard]] std::optional<bool> meets_segment(const Triangle& other, const Vec3& q) const;

 private:
  void find(const Triangle& triangle, const Ray& ray);

  Grid<Limbs> points_, directions_;
  VectorOf<Integer<Limbs>> o_{}, d_{};
  Found found_ = Found::unknown;
  Ratio<Integer<3 * Limbs>> t_{};  // in units of points_ divided by units of directions_
  Enclosure bounds_{};
};

}  // namespace microtrace::exact
