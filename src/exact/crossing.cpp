#include "exact/crossing.hpp"

#include "exact/flat.hpp"
#include "exact/grid.hpp"
#include "exact/queries.hpp"

#include <optional>

namespace microtrace::exact {
namespace {

/// Classifies the ray t d, t >= 0. The vertices are relative to the ray's origin.
template <class Number>
Crossing crossing(const CornersOf<Number>& corners, const VectorOf<Number>& d) {
  const auto stretch = meet(d, corners);
  if (!stretch) return Crossing::none;
  const int first = stretch->lo.p.sign(), last = stretch->hi.p.sign();
  if (last < 0) return Crossing::none;
  if (first <= 0) return Crossing::origin;
  const auto& [a, b, c] = corners;
  const bool is_inside = edge_volume(d, b, c).sign() != 0 && edge_volume(d, c, a).sign() != 0 &&
                         edge_volume(d, a, b).sign() != 0;
  return is_inside ? Crossing::proper : Crossing::grazing;
}

/// Returns nothing if the grid can't represent the numbers.
template <int Limbs>
std::optional<Crossing> crossing_on_grid(const Triangle& triangle, const Vec3& o, const Vec3& d) {
  ++queries.grid;
  const Grid<Limbs> points({o, triangle.a, triangle.b, triangle.c}, 0), directions({d}, 0);
  const auto origin = points(o), direction = directions(d);
  if (!origin || !direction) return std::nullopt;
  const auto corners = points(triangle, *origin);
  if (!corners) return std::nullopt;
  return crossing(*corners, *direction);
}

}  // namespace

Crossing crossing(const Triangle& triangle, const Vec3& o, const Vec3& d) {
  if (const auto found = crossing_on_grid<2>(triangle, o, d)) return *found;
  if (const auto found = crossing_on_grid<3>(triangle, o, d)) return *found;
  ++queries.dyadic;
  const Vector origin = vector(o);
  return crossing(CornersOf<Dyadic>{vector(triangle.a) - origin, vector(triangle.b) - origin,
                                    vector(triangle.c) - origin},
                  vector(d));
}

}  // namespace microtrace::exact
