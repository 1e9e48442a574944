#include "exact/nearest.hpp"

#include "exact/numbers/vector.hpp"
#include "exact/queries.hpp"

#include <cmath>

namespace microtrace::exact {
namespace {

/// Returns x / y for x >= 0 and y > 0 if the quotient is within the range of float64. Two
/// truncations have an error of 2 u each, and the division adds one rounding.
double quotient(const Dyadic& x, const Dyadic& y) {
  if (x.sign() == 0) return 0;
  const Leading p = x.leading(), r = y.leading();
  return std::ldexp(p.mantissa / r.mantissa, p.exponent - r.exponent);
}

/// Returns the nearest point of the edge from vertex i to vertex j. The vertices are relative to
/// the given point.
Nearest nearest_of_side(const std::array<Vector, 3>& vertices, std::size_t i, std::size_t j) {
  const Vector edge = vertices[j] - vertices[i];
  const Dyadic length = dot(edge, edge), along = -dot(vertices[i], edge);
  const auto at_vertex = [&](std::size_t k) {
    Nearest result{.weights = {0.0F, 0.0F, 0.0F},
                   .total = 1.0F,
                   .squared_distance = {dot(vertices[k], vertices[k]), 1.0F}};
    result.weights[k] = 1.0F;
    return result;
  };
  if (along.sign() <= 0) return at_vertex(i);
  if (compare(along, length) >= 0) return at_vertex(j);
  Nearest result{
      .weights = {0.0F, 0.0F, 0.0F},
      .total = length,
      .squared_distance = {dot(vertices[i], vertices[i]) * length - square(along), length}};
  result.weights[i] = length - along;
  result.weights[j] = along;
  return result;
}

}  // namespace

Nearest nearest(const Triangle& triangle, const Vec3& p) {
  ++queries.dyadic;
  const Vector from = vector(p);
  const std::array<Vector, 3> v{vector(triangle.a) - from, vector(triangle.b) - from,
                                vector(triangle.c) - from};
  const Vector normal = cross(v[1] - v[0], v[2] - v[0]);
  if (nonzero_component(normal) >= 0) {
    // a, b and c are the barycentric coordinates of the point's projection onto the plane, times
    // normal . normal.
    const Dyadic a = dot(normal, cross(v[1], v[2]));
    const Dyadic b = dot(normal, cross(v[2], v[0]));
    const Dyadic c = dot(normal, cross(v[0], v[1]));
    if (a.sign() >= 0 && b.sign() >= 0 && c.sign() >= 0) {
      const Dyadic squared_normal = dot(normal, normal);
      return {.weights = {a, b, c},
              .total = squared_normal,
              .squared_distance = {square(dot(normal, v[0])), squared_normal}};
    }
  }
  Nearest best = nearest_of_side(v, 0, 1);
  for (const auto& [i, j] : {std::array<std::size_t, 2>{1, 2}, std::array<std::size_t, 2>{2, 0}}) {
    const Nearest other = nearest_of_side(v, i, j);
    if (compare_distances(other, best) < 0) best = other;
  }
  return best;
}

double distance(const Nearest& nearest) {
  const auto& [p, r] = nearest.squared_distance;
  if (p.sign() == 0) return 0;
  // Takes an even power of two out of the square root, because squared distances may exceed the
  // range of float64.
  const Leading x = p.leading(), y = r.leading();
  const int exponent = x.exponent - y.exponent, odd = exponent & 1;
  return std::ldexp(std::sqrt(std::ldexp(x.mantissa / y.mantissa, odd)), (exponent - odd) / 2);
}

DVec3 barycentrics(const Nearest& nearest) {
  return {quotient(nearest.weights[0], nearest.total), quotient(nearest.weights[1], nearest.total),
          quotient(nearest.weights[2], nearest.total)};
}

}  // namespace microtrace::exact
