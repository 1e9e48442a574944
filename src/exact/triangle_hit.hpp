#pragma once
/// Exact queries about a ray's hit with a triangle and about a triangle's plane. They use
/// fixed-width integers if these can represent all numbers, otherwise Dyadic.

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
  /// The ray must outlive this object.
  TriangleHit(const Triangle& triangle, const Ray& ray)
      : triangle_(triangle), ray_(&ray), narrow_(triangle, ray) {}

  /// Returns true if the ray hits the triangle, as defined by first_hit(). The other functions
  /// require a hit.
  [[nodiscard]] bool exists();

  /// Returns bounds of the hit's t.
  [[nodiscard]] Enclosure bounds();
  /// Returns t rounded to the nearest float32.
  [[nodiscard]] float t();
  /// Returns o + t d with each coordinate rounded to the nearest float32.
  [[nodiscard]] Vec3 point();
  /// Compares t with the t of the ray's hit with another triangle, which must exist.
  [[nodiscard]] std::strong_ordering order(const Triangle& other);
  /// Returns the side of another triangle's plane on which the hit point o + t d is.
  [[nodiscard]] int side(const Triangle& other);
  /// See exact::meets_segment().
  [[nodiscard]] bool meets_segment(const Triangle& other, const Vec3& q);
  /// Returns the exact t.
  [[nodiscard]] const Root& root();

 private:
  [[nodiscard]] const GridHit<3>& wide();
  /// Returns ask(grid) for the first grid that can represent the query, or nothing if none can.
  template <class Ask>
  [[nodiscard]] auto on_grid(const Ask& ask);
  [[nodiscard]] const std::optional<Root>& dyadic();

  Triangle triangle_;
  const Ray* ray_;
  GridHit<2> narrow_;
  std::optional<GridHit<3>> wide_;             // created on first use
  std::optional<std::optional<Root>> dyadic_;  // created on first use
};

class TrianglePlane {
 public:
  explicit TrianglePlane(const Triangle& triangle) : triangle_(triangle), narrow_(triangle) {}

  /// Returns the side of the plane on which q is: the sign of (b - a) x (c - a) . (q - a).
  [[nodiscard]] int side(const Vec3& q);
  /// Returns the sign of (b - a) x (c - a) . e.
  [[nodiscard]] int slope(const Vec3& e);
  /// Returns (b - a) x (c - a), rounded to float64.
  [[nodiscard]] DVec3 normal();
  /// Returns true if the normal is not zero.
  [[nodiscard]] bool has_area();

 private:
  [[nodiscard]] const GridPlane<3>& wide();
  /// Returns ask(grid) for the first grid that can represent the query, or nothing if none can.
  template <class Ask>
  [[nodiscard]] auto on_grid(const Ask& ask);

  Triangle triangle_;
  GridPlane<2> narrow_;
  std::optional<GridPlane<3>> wide_;  // created on first use
};

}  // namespace microtrace::exact
