#include "render/shading/surface_point.hpp"

#include "render/kernels/find_points.hpp"
#include "render/shading/hit_lanes.hpp"
#include "render/shading/normals.hpp"

#include <microtrace/surface_interaction.hpp>

#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

template <typename Value>
Value weighed(const std::array<std::uint32_t, 3>& corners, const Vec3& weights,
              const Array<Value>& values) {
  return weights.x * values[corners[0]] + weights.y * values[corners[1]] +
         weights.z * values[corners[2]];
}

}  // namespace

SurfacePoint rounded(const SurfaceInteraction& at, const Ray& ray, const Hit& hit) {
  SurfacePoint result{.p = Vec3(at.p),
                      .n = Vec3(at.n),
                      .ns = Vec3(at.ns),
                      .front = at.front,
                      .distance = hit.t * std::sqrt(glm::dot(ray.d, ray.d))};
  if (!at.triangle || !at.triangle->mesh) return result;
  result.mesh = at.triangle->mesh;
  result.is_edge_on = true;
  result.corners = at.triangle->corners;
  result.barycentrics = Vec3(at.triangle->barycentrics);
  result.find_first_uv();
  return result;
}

Vec2 SurfacePoint::further_uv(std::uint32_t set) const {
  if (!mesh) return Vec2(0);
  const auto& sets = mesh.arrays->uv_sets;
  return set < sets.size() && !sets[set].empty() ? weighed(corners, barycentrics, sets[set])
                                                 : Vec2(0);
}

Vec4 SurfacePoint::color() const {
  return vertex_color(mesh, corners, barycentrics);
}

Vec4 vertex_color(const PlacedMesh& mesh, const std::array<std::uint32_t, 3>& corners,
                  const Vec3& barycentrics) {
  if (!mesh || mesh.arrays->colors.empty()) return Vec4(1);
  return weighed(corners, barycentrics, mesh.arrays->colors);
}

Vec4 SurfacePoint::tangent() const {
  if (!mesh || mesh.arrays->tangents.empty()) return Vec4(0);
  const Vec4 first = mesh.tangent(corners[0]);
  const Vec3 sum(barycentrics.x * first + barycentrics.y * mesh.tangent(corners[1]) +
                 barycentrics.z * mesh.tangent(corners[2]));
  const Tangent<1> tangent = tangent_along<1>(sum, first.w, ns);
  return tangent.handedness == 0 ? Vec4(0) : Vec4(tangent.t, tangent.handedness);
}

SurfacePoint surface_point(const Primitives& primitives, const Ray& ray, const Hit& hit,
                           const PlacedMesh& mesh, std::size_t triangle) {
  if (!mesh) return rounded(interact(primitives, ray, hit), ray, hit);
  SurfacePoint at;
  at.mesh = mesh;
  at.corners = mesh.corners(triangle);
  HitArrays<1> lanes;
  put(lanes.o, 0, ray.o);
  put(lanes.d, 0, ray.d);
  put_positions(lanes, 0, mesh, at.corners);
  put_attributes(lanes, 0, mesh, at.corners);
  find_points<1>(lanes);
  // Triangles that are edge-on or have no area are rare.
  if (lanes.is_sure[0] == 0) return rounded(interact(primitives, ray, hit), ray, hit);
  get_sure_point(lanes, 0, at);
  return at;
}

SurfacePoint texture_point(const PlacedMesh& mesh, std::size_t triangle, const Vec3& barycentrics) {
  SurfacePoint at{.mesh = mesh, .corners = mesh.corners(triangle), .barycentrics = barycentrics};
  at.find_first_uv();
  return at;
}

SurfacePoint surface_point(const PlacedMesh& mesh, std::size_t triangle, const Vec3& barycentrics,
                           bool front) {
  SurfacePoint at = texture_point(mesh, triangle, barycentrics);
  at.front = front;
  const Triangle t = triangle_of(mesh, triangle);
  at.p = barycentrics.x * t.a + barycentrics.y * t.b + barycentrics.z * t.c;
  const DVec3 a(t.a);
  const DVec3 n = glm::cross(DVec3(t.b) - a, DVec3(t.c) - a);
  const double area = std::sqrt(glm::dot(n, n));
  if (!(area > 0)) return at;
  HitArrays<1> lanes;
  put_attributes(lanes, 0, mesh, at.corners);
  put(lanes.n, 0, Vec3(n / area));
  put(lanes.weights, 0, barycentrics);
  lanes.area[0] = static_cast<float>(area);
  interpolate<1>(lanes, 0);
  get_attributes(lanes, 0, at);
  return at;
}

}  // namespace microtrace
