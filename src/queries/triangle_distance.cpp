#include "queries/triangle_distance.hpp"

#include "accel/filters/roundings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

double largest(const DVec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// The triangle relative to the point p, and the numbers that determine the feature nearest to p,
/// with error bounds. The bounds allow more roundings than there are, which covers second-order
/// terms and the roundings of the bounds themselves.
class Regions {
 public:
  Regions(const Triangle& t, const Vec3& p)
      : vertices{DVec3(t.a) - DVec3(p), DVec3(t.b) - DVec3(p), DVec3(t.c) - DVec3(p)},
        edges{DVec3(t.b) - DVec3(t.a), DVec3(t.c) - DVec3(t.b), DVec3(t.a) - DVec3(t.c)} {
    for (const DVec3& v : vertices) size = std::max(size, largest(v));
    for (const DVec3& e : edges) edge = std::max(edge, largest(e));
    normal = glm::cross(edges[0], -edges[2]);
    // e.A has three terms. Each has five roundings: two of the factors, one of the product, and two
    // of the sum.
    along_error = 3 * 8 * kRoundoff * edge * size;
    // (n x e).A has twelve terms of at most edge^3 size. Each has eleven roundings: four of n, one
    // each of e, the product, the difference, A and the second product, and two of the sum.
    side_error = 12 * 16 * kRoundoff * edge * edge * edge * size;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      from_start[i] = -glm::dot(edges[i], vertices[i]);
      from_end[i] = glm::dot(edges[i], vertices[j]);
      side[i] = -glm::dot(glm::cross(normal, edges[i]), vertices[i]);
    }
  }

  std::array<DVec3, 3> vertices, edges;  // vectors A, B, C from p to the vertices; edges ab, bc, ca
  DVec3 normal{0};
  double size = 0, edge = 0;
  /// For each edge e from A to B: from_start = -e.A is positive if p is beyond A along the edge,
  /// from_end = e.B is positive if p is before B, and side = -(n x e).A is positive if p is on the
  /// inner side of the edge.
  std::array<double, 3> from_start{}, from_end{}, side{};
  double along_error, side_error;
};

bool is_positive(double x, double error) {
  return x > error;
}
bool is_negative(double x, double error) {
  return x < -error;
}

/// Sets feature, weights, is_certain and position_error.
void find_nearest(const Regions& r, TriangleDistance& result) {
  result.is_certain = false;
  result.position_error = std::numeric_limits<double>::infinity();
  // Vertex i is the nearest feature if p is not beyond it along the edge that starts there, and not
  // before it along the edge that ends there.
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t before = (i + 2) % 3;
    if (!(r.from_start[i] <= 0 && r.from_end[before] <= 0)) continue;
    result.feature = static_cast<Feature>(i);
    result.weights = DVec3(0);
    result.weights[static_cast<int>(i)] = 1;
    result.is_certain = is_negative(r.from_start[i], r.along_error) &&
                        is_negative(r.from_end[before], r.along_error);
    result.position_error = 0;
    return;
  }
  // An edge is the nearest feature if p is on its outer side and between its ends. If roundings
  // make this true for several edges, any of them is accurate enough.
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(r.side[i] <= 0 && r.from_start[i] >= 0 && r.from_end[i] >= 0)) continue;
    const std::size_t j = (i + 1) % 3;
    const double length = r.from_start[i] + r.from_end[i];
    const double t = length > 0 ? r.from_start[i] / length : 0;
    result.feature = static_cast<Feature>(3 + i);
    result.weights = DVec3(0);
    result.weights[static_cast<int>(i)] = 1 - t;
    result.weights[static_cast<int>(j)] = t;
    result.is_certain = is_negative(r.side[i], r.side_error) &&
                        is_positive(r.from_start[i], r.along_error) &&
                        is_positive(r.from_end[i], r.along_error);
    // The error of t is the sum of the errors of from_start and `length`, relative to `length`.
    if (result.is_certain)
      result.position_error = 4 * r.along_error / length * 2 * r.edge + 8 * kRoundoff * r.edge;
    return;
  }
  const double total = r.side[0] + r.side[1] + r.side[2];
  result.feature = Feature::face;
  if (!(total > 0)) {  // the triangle has zero area
    result.weights = DVec3(1, 0, 0);
    return;
  }
  // The weight of a vertex is proportional to `side` of the opposite edge.
  const double b = std::clamp(r.side[2] / total, 0.0, 1.0);
  const double c = std::clamp(r.side[0] / total, 0.0, 1 - b);
  result.weights = DVec3(1 - b - c, b, c);
  result.is_certain =
      std::ranges::all_of(r.side, [&](double s) { return is_positive(s, r.side_error); }) &&
      total > 8 * r.side_error;
  if (result.is_certain)
    result.position_error = 16 * r.side_error / total * 2 * r.edge + 16 * kRoundoff * r.edge;
}

}  // namespace

/// The upper bound is the distance of a point of the triangle. For any vector G, no vertex and
/// therefore no point of the triangle is nearer than the least of A.G / |G|, B.G / |G|, C.G / |G|,
/// which is the lower bound. If G is the vector to the nearest point, both bounds are equal.
TriangleDistance triangle_distance(const Triangle& triangle, const Vec3& p) {
  const Regions regions(triangle, p);
  TriangleDistance result{};
  result.size = regions.size;
  find_nearest(regions, result);
  const auto& [a, b, c] = regions.vertices;
  const DVec3 g = result.weights.x * a + result.weights.y * b + result.weights.z * c;
  const double length = std::sqrt(glm::dot(g, g));
  // A component of g has three terms with five roundings, whose weights add up to 1 within 2 u,
  // where u is the unit roundoff. A vector's length is at most twice its largest component, and
  // computing the length adds four roundings. A.G has three terms with four roundings; |G| and the
  // quotient have five.
  const double error = 32 * kRoundoff * regions.size;
  result.hi = length + error;
  const double least = std::min({glm::dot(a, g), glm::dot(b, g), glm::dot(c, g)});
  result.lo = length > 0 ? std::max(0.0, least / length - error) : 0;
  return result;
}

bool share_feature(const Triangle& s, const TriangleDistance& of_s, const Triangle& t,
                   const TriangleDistance& of_t) {
  if (!of_s.is_certain || !of_t.is_certain || of_s.feature == Feature::face ||
      of_t.feature == Feature::face)
    return false;
  struct Ends {
    Vec3 first, second;
  };
  const auto ends = [](const Triangle& triangle, Feature feature) {
    const std::array<Vec3, 3> v{triangle.a, triangle.b, triangle.c};
    const auto i = static_cast<std::size_t>(feature);
    return i < 3 ? Ends{v[i], v[i]} : Ends{v[i - 3], v[(i - 2) % 3]};
  };
  const Ends x = ends(s, of_s.feature), y = ends(t, of_t.feature);
  return (x.first == y.first && x.second == y.second) ||
         (x.first == y.second && x.second == y.first);
}

}  // namespace microtrace
