#pragma once
/// Questions about triangles in integers of fixed width, for coordinates that lie on one grid: they
/// nearly always do, and the answers are exact.
///
/// A float32 is an integer of 24 bits times a power of two. With two limbs, coordinates of a scene
/// may differ by a factor of 2^80: 500 and 1e-17, what is left of a zero after a rotation, fit.
/// With three they may by 2^144: 1e-45, the least number, and 10^8. So they do where a ray leaves a
/// wall at 0.

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

  /// As fine as may be for vectors whose components are below 2^spare times the largest of these.
  Grid(std::initializer_list<Vec3> vectors, int spare);

  /// The unit is 2^exponent.
  [[nodiscard]] int exponent() const { return exponent_; }

  /// In units; nothing if a component is no multiple of it, is too large or not finite.
  [[nodiscard]] std::optional<GridVector> operator()(const Vec3& v) const;
  /// Seen from a vector on the grid.
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

  // Nothing where the grid holds not all that it takes.

  /// On which side of the plane q is: the sign of (b - a) x (c - a) . (q - a).
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

  // Of a hit. Nothing where the grid holds not all that it takes.

  /// Around its t.
  [[nodiscard]] const Enclosure& bounds() const { return bounds_; }
  /// Rounded to the nearest float32.
  [[nodiscard]] std::optional<float> t() const;
  /// o + t d with each coordinate rounded to the nearest.
  [[nodiscard]] std::optional<Vec3> point() const;
  /// t against that of the ray's hit with another triangle, one that it does hit.
  [[nodiscard]] std::optional<std::strong_ordering> order(const Triangle& other) const;
  /// On which side of another triangle's plane the point o + t d is.
  [[nodiscard]] std::optional<int> side(const Triangle& other) const;
  /// meets_segment() with another triangle.
  [[nodiscard]] std::optional<bool> meets_segment(const Triangle& other, const Vec3& q) const;

 private:
  void find(const Triangle& triangle, const Ray& ray);

  Grid<Limbs> points_, directions_;
  VectorOf<Integer<Limbs>> o_{}, d_{};
  Found found_ = Found::unknown;
  Ratio<Integer<3 * Limbs>> t_{};  // in units of the points by those of directions
  Enclosure bounds_{};
};

}  // namespace microtrace::exact
