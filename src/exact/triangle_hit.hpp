#pragma once
/// A ray's hit with a triangle, and a triangle's plane, asked exactly: by integers of fixed width
/// where they hold all numbers, else by Dyadic.

#include "exact/grid.hpp"
#include "exact/numbers/root.hpp"

#include <microtrace/math.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <compare>
#include <optional>

namespace microtrace::exact {

class TriangleHit {
 public:
  /// The ray must outlive it.
  TriangleHit(const Triangle& triangle, const Ray& ray)
      : triangle_(triangle), ray_(&ray), narrow_(triangle, ray) {}

  /// Whether there is one, as first_hit() has it. All else is asked of hits.
  [[nodiscard]] bool exists();

  /// Around its t.
  [[nodiscard]] Enclosure bounds();
  /// Its t, rounded to the nearest float32.
  [[nodiscard]] float t();
  /// o + t d with each coordinate rounded to the nearest.
  [[nodiscard]] Vec3 point();
  /// Its t against that of the ray's hit with another triangle.
  [[nodiscard]] std::strong_ordering order(const Triangle& other);
  /// On which side of another triangle's plane the point o + t d is.
  [[nodiscard]] int side(const Triangle& other);
  /// See exact::meets_segment().
  [[nodiscard]] bool meets_segment(const Triangle& other, const Vec3& q);
  /// Its t itself.
  [[nodiscard]] const Root& root();

 private:
  [[nodiscard]] const GridHit<3>& wide();
  /// What the first grid says that can, of a hit.
  template <class Ask>
  [[nodiscard]] auto on_grid(const Ask& ask);
  [[nodiscard]] const std::optional<Root>& dyadic();

  Triangle triangle_;
  const Ray* ray_;
  GridHit<2> narrow_;
  std::optional<GridHit<3>> wide_;             // made on first need
  std::optional<std::optional<Root>> dyadic_;  // too
};

class TrianglePlane {
 public:
  explicit TrianglePlane(const Triangle& triangle) : triangle_(triangle), narrow_(triangle) {}

  /// On which side of the plane q is: the sign of (b - a) x (c - a) . (q - a).
  [[nodiscard]] int side(const Vec3& q);
  /// The sign of (b - a) x (c - a) . e.
  [[nodiscard]] int slope(const Vec3& e);
  /// (b - a) x (c - a), rounded.
  [[nodiscard]] DVec3 normal();
  /// Whether that is not zero.
  [[nodiscard]] bool has_area();

 private:
  [[nodiscard]] const GridPlane<3>& wide();
  /// What the first grid says that can.
  template <class Ask>
  [[nodiscard]] auto on_grid(const Ask& ask);

  Triangle triangle_;
  GridPlane<2> narrow_;
  std::optional<GridPlane<3>> wide_;  // made on first need
};

}  // namespace microtrace::exact
