#include "render/shading/surface_point.hpp"

#include <microtrace/surface_interaction.hpp>

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

template <typename Value>
Value weighed(const SurfacePoint& at, const std::vector<Value>& values) {
  return at.barycentrics.x * values[at.corners[0]] + at.barycentrics.y * values[at.corners[1]] +
         at.barycentrics.z * values[at.corners[2]];
}

/// Twice the area of a triangle in texture coordinates.
float uv_area(const std::vector<Vec2>& uv, const std::array<std::uint32_t, 3>& corners) {
  const Vec2 e1 = uv[corners[1]] - uv[corners[0]], e2 = uv[corners[2]] - uv[corners[0]];
  return std::abs(e1.x * e2.y - e1.y * e2.x);
}

/// n is the cross product of the triangle's edges, `area` its length.
void add_attributes(const DVec3& n, double area, SurfacePoint& at) {
  const Mesh& mesh = *at.mesh;
  at.n = Vec3(n / area);
  at.ns = at.n;
  if (!mesh.normals.empty()) {
    const Vec3 ns = weighed(at, mesh.normals);
    const float square = glm::dot(ns, ns);
    if (square > 0) at.ns = ns / std::sqrt(square);
    // In some files the winding contradicts the normals; the winding defines the front.
    if (glm::dot(at.ns, at.n) < 0) at.ns = -at.ns;
  }
  if (!mesh.uv_sets.empty() && !mesh.uv_sets[0].empty()) {
    at.first_uv = weighed(at, mesh.uv_sets[0]);
    at.uv_scale = std::sqrt(uv_area(mesh.uv_sets[0], at.corners) / static_cast<float>(area));
  }
}

SurfacePoint rounded(const SurfaceInteraction& at, const Ray& ray, const Hit& hit) {
  return {.p = Vec3(at.p),
          .n = Vec3(at.n),
          .ns = Vec3(at.ns),
          .front = at.front,
          .distance = hit.t * std::sqrt(glm::dot(ray.d, ray.d))};
}

}  // namespace

Vec2 SurfacePoint::further_uv(std::uint32_t set) const {
  if (mesh == nullptr || set >= mesh->uv_sets.size() || mesh->uv_sets[set].empty()) return Vec2(0);
  return weighed(*this, mesh->uv_sets[set]);
}

Vec4 SurfacePoint::color() const {
  return mesh == nullptr || mesh->colors.empty() ? Vec4(1) : weighed(*this, mesh->colors);
}

Vec4 SurfacePoint::tangent() const {
  if (mesh == nullptr || mesh->tangents.empty()) return Vec4(0);
  const Vec3 sum(weighed(*this, mesh->tangents));
  const Vec3 t = sum - ns * glm::dot(ns, sum);
  const float square = glm::dot(t, t);
  if (!(square > 0)) return Vec4(0);
  return {t / std::sqrt(square), mesh->tangents[corners[0]].w};
}

SurfacePoint surface_point(const Primitives& primitives, const Ray& ray, const Hit& hit,
                           const Mesh* mesh, std::size_t triangle) {
  if (mesh == nullptr) return rounded(interact(primitives, ray, hit), ray, hit);
  SurfacePoint at;
  at.mesh = mesh;
  at.corners = mesh->triangles[triangle];
  const auto& [i, j, k] = at.corners;
  // The intersection with the triangle's plane in float64, because Hit::t is rounded to float32.
  const DVec3 a(mesh->positions[i]), o(ray.o), d(ray.d);
  const DVec3 e1 = DVec3(mesh->positions[j]) - a, e2 = DVec3(mesh->positions[k]) - a;
  const DVec3 n = glm::cross(e1, e2);
  const double square = glm::dot(n, n), slope = glm::dot(n, d);
  const double t = glm::dot(a - o, n) / slope;
  // Edge-on or without area: rare, needs the careful version.
  if (!(square > 0) || !(std::abs(t - hit.t) <= 0x1p-20 * hit.t))
    return rounded(interact(primitives, ray, hit), ray, hit);
  const DVec3 p = o + t * d, from_a = p - a;
  const double inverse = 1 / square;
  const double v = std::max(glm::dot(glm::cross(from_a, e2), n) * inverse, 0.0);
  const double w = std::max(glm::dot(glm::cross(e1, from_a), n) * inverse, 0.0);
  const double u = std::max(1 - v - w, 0.0), sum = u + v + w;
  at.p = Vec3(p);
  at.barycentrics = Vec3(u / sum, v / sum, w / sum);
  at.front = !(slope > 0);
  at.distance = static_cast<float>(t * std::sqrt(glm::dot(d, d)));
  add_attributes(n, std::sqrt(square), at);
  return at;
}

SurfacePoint surface_point(const Mesh& mesh, std::size_t triangle, const Vec3& barycentrics,
                           bool front) {
  SurfacePoint at;
  at.mesh = &mesh;
  at.corners = mesh.triangles[triangle];
  at.barycentrics = barycentrics;
  at.front = front;
  at.p = weighed(at, mesh.positions);
  const DVec3 a(mesh.positions[at.corners[0]]);
  const DVec3 n = glm::cross(DVec3(mesh.positions[at.corners[1]]) - a,
                             DVec3(mesh.positions[at.corners[2]]) - a);
  const double area = std::sqrt(glm::dot(n, n));
  if (area > 0) add_attributes(n, area, at);
  return at;
}

}  // namespace microtrace
