#pragma once
/// Exact queries about triangles in fixed-width integers, for coordinates on a common grid. Nearly
/// all scenes fit.
///
/// A float32 is a 24-bit integer times a power of two. With two limbs, the coordinates of a query
/// may differ by a factor of 2^80: for example 500 and 1e-17, the remainder of a zero after a
/// rotation. With three limbs they may differ by 2^144: 1e-45, the least float32, and 10^8, which
/// occur for rays that leave a wall at coordinate 0.

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

  /// The finest grid for vectors whose components are below 2^spare times the largest component of
  /// these.
  Grid(std::initializer_list<Vec3> vectors, int spare);

  /// The unit is 2^exponent.
  [[nodiscard]] int exponent() const { return exponent_; }

  /// In units of the grid; nothing if a component is not a multiple of the unit, is too large or
  /// not finite.
  [[nodiscard]] std::optional<GridVector> operator()(const Vec3& v) const;
  /// The vertices relative to a vector on the grid.
  [[nodiscard]] std::optional<GridCorners> operator()(const Triangle& t,
                                                      const GridVector& from) const;

 private:
  int exponent_;
};

/// A triangle's plane.
template <int Limbs>
class GridPlane {
 public:
  explicit GridPlane(const Triangle& triangle);

  // All functions return nothing if the grid can't represent the numbers they need.

  /// The side of the plane on which q is: the sign of (b - a) x (c - a) . (q - a).
  [[nodiscard]] std::optional<int> side(const Vec3& q) const;
  /// The sign of (b - a) x (c - a) . e.
  [[nodiscard]] std::optional<int> slope(const Vec3& e) const;
  /// (b - a) x (c - a), rounded.
  [[nodiscard]] std::optional<DVec3> normal() const;
  [[nodiscard]] std::optional<bool> has_area() const;

 private:
  Grid<Limbs> grid_;
  VectorOf<Integer<Limbs>> a_{};
  std::optional<VectorOf<Integer<2 * Limbs>>> normal_;
};

enum class Found { unknown, miss, hit };

/// The hit of a ray with a triangle.
template <int Limbs>
class GridHit {
 public:
  GridHit(const Triangle& triangle, const Ray& ray);

  [[nodiscard]] Found found() const { return found_; }

  // Queries about a hit. They return nothing if the grid can't represent the numbers they need.

  /// Bounds of its t.
  [[nodiscard]] const Enclosure& bounds() const { return bounds_; }
  /// t rounded to the nearest float32.
  [[nodiscard]] std::optional<float> t() const;
  /// o + t d with each coordinate rounded to nearest.
  [[nodiscard]] std::optional<Vec3> point() const;
  /// The order of t and the t of the ray's hit with another triangle, which must exist.
  [[nodiscard]] std::optional<std::strong_ordering> order(const Triangle& other) const;
  /// The side of another triangle's plane on which the point o + t d is.
  [[nodiscard]] std::optional<int> side(const Triangle& other) const;
  /// meets_segment() with another triangle.
  [[nodiscard]] std::optional<bool> meets_segment(const Triangle& other, const Vec3& q) const;

 private:
  void find(const Triangle& triangle, const Ray& ray);

  Grid<Limbs> points_, directions_;
  VectorOf<Integer<Limbs>> o_{}, d_{};
  Found found_ = Found::unknown;
  Ratio<Integer<3 * Limbs>> t_{};  // in units of points per unit of directions
  Enclosure bounds_{};
};

}  // namespace microtrace::exact
