#include "scene/kernels/triangle.hpp"

#include <microtrace/surface_interaction.hpp>

#include <algorithm>
#include <cmath>
#include <variant>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// The normalized v, or `otherwise` if v is zero.
DVec3 direction_or(const DVec3& v, const DVec3& otherwise) {
  const auto direction = direction_of<1>(v);
  return direction.exists ? direction.v : otherwise;
}

/// Barycentric weights of the point on the segment a b that is nearest to p.
DVec2 nearest_on_segment(const DVec3& a, const DVec3& b, const DVec3& p) {
  const double square = glm::dot(b - a, b - a);
  const double s = square > 0 ? std::clamp(glm::dot(p - a, b - a) / square, 0.0, 1.0) : 0;
  return {1 - s, s};
}

TriangleCorners<1> corners_of(const Triangle& s) {
  return {DVec3(s.a), DVec3(s.b), DVec3(s.c)};
}

/// Barycentric coordinates of the point on the longest edge that is nearest to p. Used for
/// triangles that have no area or are seen exactly edge-on.
DVec3 barycentrics_on_edge(const TriangleCorners<1>& t, const DVec3& p) {
  const std::array corners{t.a, t.b, t.c};
  std::size_t longest = 0;
  double greatest = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const DVec3 edge = corners[(i + 1) % 3] - corners[i];
    const double square = glm::dot(edge, edge);
    if (square > greatest) longest = i, greatest = square;
  }
  const std::size_t other = (longest + 1) % 3;
  const DVec2 weights = nearest_on_segment(corners[longest], corners[other], p);
  DVec3 result(0);
  result[static_cast<glm::length_t>(longest)] = weights.x;
  result[static_cast<glm::length_t>(other)] = weights.y;
  return result;
}

/// Refines t, a float32 approximation of a root of a t^2 + 2 b t + c, by Newton's method as long as
/// the result stays near t.
double polished_root(double a, double b, double c, float t) {
  double x = t;
  for (int i = 0; i < 3; ++i) {
    const double step = ((a * x + 2 * b) * x + c) / (2 * (a * x + b));
    const double next = x - step;
    if (!(std::abs(next - t) <= 0x1p-22 * t)) return x;
    x = next;
  }
  return x;
}

class Interaction {
 public:
  Interaction(const Primitives& primitives, const Ray& ray, const Hit& hit)
      : primitives_(primitives), ray_(ray), hit_(hit), o_(ray.o), d_(ray.d) {}

  SurfaceInteraction operator()(const Sphere& s) const {
    const DVec3 center(s.center), from_center = o_ - center;
    const double r = s.radius;
    const double t = polished_root(glm::dot(d_, d_), glm::dot(from_center, d_),
                                   glm::dot(from_center, from_center) - r * r, hit_.t);
    const DVec3 n = direction_or(from_center + t * d_, facing());
    return at(center + r * n, n);
  }

  SurfaceInteraction operator()(const Plane& s) const { return planar(s.point, s.normal); }
  SurfaceInteraction operator()(const Disc& s) const { return planar(s.center, s.normal); }

  SurfaceInteraction operator()(const Quadric& q) const {
    // The quadric's polynomial at o + t d is d.Q d t^2 + d.gradient(o) t + value(o).
    const double a = glm::dot(d_, half_gradient(q, d_, 0));
    const DVec3 half = half_gradient(q, o_, 1);
    const double c = glm::dot(o_, half_gradient(q, o_, 2)) + double{q.j};
    const DVec3 p = o_ + polished_root(a, glm::dot(d_, half), c, hit_.t) * d_;
    return at(p, direction_or(half_gradient(q, p, 1), facing()));
  }

  SurfaceInteraction operator()(const Triangle& s) const {
    const TriangleCorners<1> t = corners_of(s);
    const auto inside = barycentrics_of<1>(t, o_, d_);
    const DVec3 w =
        inside.exists ? inside.v : barycentrics_on_edge(t, o_ + static_cast<double>(hit_.t) * d_);
    SurfaceInteraction result =
        at(weighted(w, t.a, t.b, t.c), direction_or(area_vector<1>(t), facing()));
    result.front = shows_front(s, ray_.d);
    result.triangle = TrianglePoint{.barycentrics = w, .mesh = nullptr, .corners = {}};
    const auto* mesh = std::get_if<Mesh>(&primitives_.scene().objects[result.object].shape);
    if (mesh == nullptr) return result;
    const auto vertices = mesh->corners(result.primitive);
    result.triangle->mesh = mesh;
    result.triangle->corners = vertices;
    if (!mesh->normals.empty()) {
      const auto normal = [&](std::size_t i) { return DVec3(mesh->normal(vertices[i])); };
      result.ns = direction_or(weighted(w, normal(0), normal(1), normal(2)), result.n);
    }
    return result;
  }

  SurfaceInteraction operator()(const Mesh&) const { return {}; }  // never called

 private:
  [[nodiscard]] DVec3 facing() const { return direction_or(-d_, DVec3(0, 0, 1)); }

  [[nodiscard]] SurfaceInteraction at(const DVec3& p, const DVec3& n) const {
    const std::size_t object = primitives_.object_index(hit_.id);
    return {.p = p,
            .n = n,
            .ns = n,
            .front = !(glm::dot(d_, n) > 0),
            .object = object,
            .primitive = hit_.id - primitives_.first_id_of(object)};
  }

  [[nodiscard]] SurfaceInteraction planar(const DVec3& point, const DVec3& normal) const {
    const double t = glm::dot(point - o_, normal) / glm::dot(d_, normal);
    const double t_hit = hit_.t;
    const bool sure = std::abs(t - t_hit) <= 0x1p-22 * t_hit;
    return at(o_ + (sure ? t : t_hit) * d_, direction_or(normal, facing()));
  }

  /// Half the gradient at v, with the contribution of the polynomial's linear terms (g, h, i)
  /// multiplied by `weight`. With weight 2, its dot product with v is the polynomial's value minus
  /// j.
  static DVec3 half_gradient(const Quadric& q, const DVec3& v, double weight) {
    const double d = q.d, e = q.e, f = q.f;
    return {q.a * v.x + (d * v.y + e * v.z + weight * q.g) / 2,
            q.b * v.y + (d * v.x + f * v.z + weight * q.h) / 2,
            q.c * v.z + (e * v.x + f * v.y + weight * q.i) / 2};
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
  if (!triangle || triangle->mesh == nullptr) return std::nullopt;
  const auto& sets = triangle->mesh->uv_sets;
  return set < sets.size() ? interpolate<DVec2>(*triangle, sets[set]) : std::nullopt;
}

DVec2 SurfaceInteraction::uv_step(std::size_t set, const DVec3& dp) const {
  if (!uv(set)) return DVec2(0);
  const Mesh& mesh = *triangle->mesh;
  const auto& [i, j, k] = triangle->corners;
  // Solves dp = s (b - a) + t (c - a) for s and t.
  const DVec3 a(mesh.position(i));
  const DVec3 ab = DVec3(mesh.position(j)) - a, ac = DVec3(mesh.position(k)) - a;
  const DVec3 cross = glm::cross(ab, ac);
  const double square = glm::dot(cross, cross);
  if (!(square > 0)) return DVec2(0);
  const double s = glm::dot(cross, glm::cross(dp, ac)) / square;
  const double t = glm::dot(cross, glm::cross(ab, dp)) / square;
  const auto& values = mesh.uv_sets[set];
  const DVec2 at_a(values[i]);
  return s * (DVec2(values[j]) - at_a) + t * (DVec2(values[k]) - at_a);
}

DVec4 SurfaceInteraction::color() const {
  if (!triangle || triangle->mesh == nullptr) return DVec4(1);
  return interpolate<DVec4>(*triangle, triangle->mesh->colors).value_or(DVec4(1));
}

bool shows_front(const Triangle& triangle, const Vec3& d) {
  return !(glm::dot(DVec3(d), area_vector<1>(corners_of(triangle))) > 0);
}

SurfaceInteraction interact(const Primitives& primitives, const Ray& ray, const Hit& hit) {
  return primitives.visit(hit.id, Interaction(primitives, ray, hit));
}

}  // namespace microtrace
