#include "base/system/float_environment.hpp"
#include "exact/first_hit.hpp"
#include "exact/implicit.hpp"
#include "scene/kernels/triangle.hpp"

#include <microtrace/surface_interaction.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// The normalized v, or `otherwise` if v is zero.
DVec3 direction_or(const DVec3& v, const DVec3& otherwise) {
  const auto direction = direction_of<1>(v);
  return direction.exists ? direction.v : otherwise;
}

TriangleCorners<1> corners_of(const Triangle& s) {
  return {DVec3(s.a), DVec3(s.b), DVec3(s.c)};
}

/// Barycentric coordinates of the point of a triangle that is nearest to p, which is on the
/// triangle but for rounding. Points on edges have one weight of exactly 0.
DVec3 barycentrics_at(const TriangleCorners<1>& t, const DVec3& p) {
  const std::array corners{t.a, t.b, t.c};
  DVec3 on_edge(1, 0, 0);
  double nearest = std::numeric_limits<double>::infinity(), scale = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const DVec3 edge = corners[j] - corners[i], from = p - corners[i];
    const double square = glm::dot(edge, edge);
    const double part = square > 0 ? std::clamp(glm::dot(from, edge) / square, 0.0, 1.0) : 0;
    const DVec3 gap = from - part * edge;
    scale = std::max({scale, magnitudes_sum(corners[i]), magnitudes_sum(p)});
    if (!(glm::dot(gap, gap) < nearest)) continue;
    nearest = glm::dot(gap, gap);
    on_edge = DVec3(0);
    on_edge[static_cast<glm::length_t>(i)] = 1 - part;
    on_edge[static_cast<glm::length_t>(j)] = part;
  }
  const DVec3 area = area_vector<1>(t), from_a = p - t.a;
  const double square = glm::dot(area, area), rounding = 0x1p-48 * scale;
  if (nearest <= rounding * rounding || !(square > 0)) return on_edge;
  const double v = std::max(glm::dot(glm::cross(from_a, t.c - t.a), area) / square, 0.0);
  const double w = std::max(glm::dot(glm::cross(t.b - t.a, from_a), area) / square, 0.0);
  const double u = std::max(1 - v - w, 0.0);
  return DVec3(u, v, w) / (u + v + w);
}

/// The polynomial a t^2 + 2 b t + c.
struct QuadraticPolynomial {
  double a, b, c;

  /// Returns the root near the float32 number t, by Newton's method. Returns nothing if float64
  /// can't compute it, because it is nearly a double root or not near t. `sizes` are sums of the
  /// magnitudes of the terms of a, b and c.
  [[nodiscard]] std::optional<double> root_near(float t, const QuadraticPolynomial& sizes) const {
    const double terms = sizes.b * sizes.b + sizes.a * sizes.c;
    if (!(std::abs(b * b - a * c) > 0x1p-28 * terms)) return std::nullopt;
    double x = t;
    for (int i = 0; i < 3; ++i) x -= ((a * x + 2 * b) * x + c) / (2 * (a * x + b));
    if (!(std::abs(x - t) <= 0x1p-22 * t)) return std::nullopt;
    return x;
  }
};

/// Half the gradient of a quadric's polynomial at v, with the contribution of its linear terms (g,
/// h, i) multiplied by `weight`. With weight 2, its dot product with v is the polynomial's value
/// minus j.
DVec3 half_gradient(const Quadric& q, const DVec3& v, double weight) {
  const double d = q.d, e = q.e, f = q.f;
  return {q.a * v.x + (d * v.y + e * v.z + weight * q.g) / 2,
          q.b * v.y + (d * v.x + f * v.z + weight * q.h) / 2,
          q.c * v.z + (e * v.x + f * v.y + weight * q.i) / 2};
}

/// The quadric's polynomial at o + t d.
QuadraticPolynomial along(const Quadric& q, const DVec3& o, const DVec3& d) {
  return {.a = glm::dot(d, half_gradient(q, d, 0)),
          .b = glm::dot(d, half_gradient(q, o, 1)),
          .c = glm::dot(o, half_gradient(q, o, 2)) + double{q.j}};
}

Quadric magnitudes_of(const Quadric& q) {
  return {std::abs(q.a), std::abs(q.b), std::abs(q.c), std::abs(q.d), std::abs(q.e),
          std::abs(q.f), std::abs(q.g), std::abs(q.h), std::abs(q.i), std::abs(q.j)};
}

/// The sign of the product of a normal and a direction.
int slope_sign(const Vec3& normal, const Vec3& d) {
  // The products are exact, and their sum has two roundings.
  const DVec3 terms = DVec3(normal) * DVec3(d);
  const double slope = terms.x + terms.y + terms.z;
  if (std::abs(slope) > 0x1p-50 * magnitudes_sum(terms)) return slope < 0 ? -1 : 1;
  return dot(exact::vector(normal), exact::vector(d)).sign();
}

class Interaction {
 public:
  Interaction(const Primitives& primitives, const Ray& ray, const Hit& hit)
      : primitives_(primitives), ray_(ray), hit_(hit), o_(ray.o), d_(ray.d) {}

  SurfaceInteraction operator()(const Sphere& s) const {
    const std::optional<SphereHit> hit = hit_of(s);
    if (!hit) return exactly(s);
    const DVec3 center(s.center), n = direction_or(o_ - center + hit->t * d_, facing());
    return at(center + double{s.radius} * n, n, hit->enters);
  }

  SurfaceInteraction operator()(const Plane& s) const { return planar(s, s.point); }
  SurfaceInteraction operator()(const Disc& s) const { return planar(s, s.center); }

  SurfaceInteraction operator()(const Quadric& q) const {
    const QuadraticPolynomial sizes = along(magnitudes_of(q), glm::abs(o_), glm::abs(d_));
    const std::optional<double> t = along(q, o_, d_).root_near(hit_.t, sizes);
    if (!t) return exactly(q);
    const DVec3 p = o_ + *t * d_, n = direction_or(half_gradient(q, p, 1), facing());
    return at(p, n, !(glm::dot(d_, n) > 0));
  }

  SurfaceInteraction operator()(const Triangle& s) const {
    const TriangleCorners<1> t = corners_of(s);
    const auto inside = barycentrics_of<1>(t, o_, d_);
    SurfaceInteraction result =
        inside.exists ? at(weighted(inside.v, t.a, t.b, t.c),
                           direction_or(area_vector<1>(t), facing()), shows_front(s, ray_.d))
                      : exactly(s);
    const DVec3 w = inside.exists ? inside.v : barycentrics_at(t, result.p);
    const PlacedMesh mesh = primitives_.object_of(hit_.id).mesh;
    result.triangle = TrianglePoint{.barycentrics = w, .mesh = mesh, .corners = {}};
    if (!mesh) return result;
    const auto vertices = mesh.corners(result.primitive);
    result.triangle->corners = vertices;
    if (!mesh.arrays->normals.empty()) {
      const auto normal = [&](std::size_t i) { return DVec3(mesh.normal(vertices[i])); };
      result.ns = direction_or(weighted(w, normal(0), normal(1), normal(2)), result.n);
    }
    return result;
  }

  SurfaceInteraction operator()(const Mesh&) const { return {}; }  // never called

 private:
  struct SphereHit {
    double t;
    bool enters;
  };

  /// The hit with a sphere; nothing if the ray nearly touches it, if it is extremely far away, if
  /// the parameter exceeds float32, or if float64 can't tell which of the roots is the hit.
  [[nodiscard]] std::optional<SphereHit> hit_of(const Sphere& s) const {
    if (!std::isfinite(hit_.t)) return std::nullopt;
    const DVec3 from_center = o_ - DVec3(s.center), across = glm::cross(from_center, d_);
    const double a = glm::dot(d_, d_), b = glm::dot(from_center, d_), r = s.radius;
    // By Lagrange's identity. The difference b^2 - a c would cancel for distant spheres.
    const double offset = glm::dot(across, across), discriminant = r * r * a - offset;
    const double square = glm::dot(from_center, from_center);
    if (!(discriminant > 0 && discriminant * discriminant > 0x1p-60 * square * offset * a))
      return std::nullopt;
    if (r * r < 0x1p-60 * square) return std::nullopt;  // the normal would have a large error
    const double root = std::sqrt(discriminant), lo = (-b - root) / a, hi = (-b + root) / a;
    const double tolerance = 0x1p-22 * hit_.t + 0x1p-44 * std::sqrt(square / a);
    const bool is_near_lo = std::abs(lo - hit_.t) <= tolerance;
    const bool is_near_hi = std::abs(hi - hit_.t) <= tolerance;
    // Both roots of a distant sphere may be as near to the rounded t. The hit is the first one from
    // t_min on.
    if (is_near_lo && (!is_near_hi || lo - tolerance > ray_.t_min)) return SphereHit{lo, true};
    if (is_near_hi && (!is_near_lo || lo + tolerance < ray_.t_min)) return SphereHit{hi, false};
    return std::nullopt;
  }

  [[nodiscard]] DVec3 facing() const { return direction_or(-d_, DVec3(0, 0, 1)); }

  [[nodiscard]] SurfaceInteraction at(const DVec3& p, const DVec3& n, bool front) const {
    const std::size_t object = primitives_.object_index(hit_.id);
    return {.p = p,
            .n = n,
            .ns = n,
            .front = front,
            .object = object,
            .primitive = hit_.id - primitives_.first_id_of(object)};
  }

  [[nodiscard]] SurfaceInteraction planar(const auto& s, const DVec3& point) const {
    const DVec3 normal(s.normal);
    const double t = glm::dot(point - o_, normal) / glm::dot(d_, normal);
    if (!std::isfinite(hit_.t) || !(std::abs(t - hit_.t) <= 0x1p-22 * hit_.t)) return exactly(s);
    return at(o_ + t * d_, direction_or(normal, facing()), slope_sign(s.normal, ray_.d) <= 0);
  }

  /// The surface by exact arithmetic, which is slow.
  template <class AnyShape>
  [[nodiscard]] SurfaceInteraction exactly(const AnyShape& s) const {
    const auto t = exact::first_hit(s, ray_);
    if (!t) return at(o_ + double{hit_.t} * d_, facing(), true);  // not a hit of this ray
    const exact::Implicit f(s);
    return at(exact::round_point_to_double(ray_, *t), direction_or(f.gradient(ray_, *t), facing()),
              f.sign_behind(ray_, *t, -ray_.d) >= 0);
  }

  const Primitives& primitives_;
  const Ray& ray_;
  const Hit& hit_;
  DVec3 o_, d_;
};

/// Interpolates a vertex attribute; nothing if the mesh doesn't have it.
template <typename Result, typename Value>
std::optional<Result> interpolate(const TrianglePoint& at, const Array<Value>& values) {
  if (values.empty()) return std::nullopt;
  const auto value = [&](std::size_t i) { return Result(values[at.corners[i]]); };
  return weighted(at.barycentrics, value(0), value(1), value(2));
}

}  // namespace

std::optional<DVec2> SurfaceInteraction::uv(std::size_t set) const {
  const FloatEnvironment environment;
  if (!triangle || !triangle->mesh) return std::nullopt;
  const auto& sets = triangle->mesh.arrays->uv_sets;
  return set < sets.size() ? interpolate<DVec2>(*triangle, sets[set]) : std::nullopt;
}

DVec2 SurfaceInteraction::uv_step(std::size_t set, const DVec3& dp) const {
  const FloatEnvironment environment;
  if (!uv(set)) return DVec2(0);
  const PlacedMesh& mesh = triangle->mesh;
  const auto& [i, j, k] = triangle->corners;
  // Solves dp = s (b - a) + t (c - a) for s and t.
  const DVec3 a(mesh.position(i));
  const DVec3 ab = DVec3(mesh.position(j)) - a, ac = DVec3(mesh.position(k)) - a;
  const DVec3 cross = glm::cross(ab, ac);
  const double square = glm::dot(cross, cross);
  if (!(square > 0)) return DVec2(0);
  const double s = glm::dot(cross, glm::cross(dp, ac)) / square;
  const double t = glm::dot(cross, glm::cross(ab, dp)) / square;
  const auto& values = mesh.arrays->uv_sets[set];
  const DVec2 at_a(values[i]);
  return s * (DVec2(values[j]) - at_a) + t * (DVec2(values[k]) - at_a);
}

DVec4 SurfaceInteraction::color() const {
  const FloatEnvironment environment;
  if (!triangle || !triangle->mesh) return DVec4(1);
  return interpolate<DVec4>(*triangle, triangle->mesh.arrays->colors).value_or(DVec4(1));
}

bool shows_front(const Triangle& triangle, const Vec3& d) {
  const FloatEnvironment environment;
  const TriangleCorners<1> t = corners_of(triangle);
  const DVec3 e1 = t.b - t.a, e2 = t.c - t.a, direction(d);
  const double slope = glm::dot(direction, glm::cross(e1, e2));
  // Each term has at most six roundings and is at most the product of the three sums.
  const double terms = magnitudes_sum(e1) * magnitudes_sum(e2) * magnitudes_sum(direction);
  if (std::abs(slope) > 0x1p-48 * terms) return slope < 0;
  return dot(exact::vector(d), exact::Implicit(triangle).linear()).sign() <= 0;
}

SurfaceInteraction interact(const Primitives& primitives, const Ray& ray, const Hit& hit) {
  const FloatEnvironment environment;
  return primitives.visit(hit.id, Interaction(primitives, ray, hit));
}

}  // namespace microtrace
