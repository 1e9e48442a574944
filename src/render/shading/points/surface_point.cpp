#include "render/shading/points/surface_point.hpp"

#include "render/shading/points/find_points.hpp"
#include "render/shading/points/hit_lanes.hpp"
#include "render/shading/points/normals.hpp"
#include "scene/kernels/triangle.hpp"

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
  return mesh && has_uv(*mesh.arrays, set)
             ? weighed(corners, barycentrics, mesh.arrays->uv_sets[set])
             : Vec2(0);
}

float SurfacePoint::further_uv_scale(std::uint32_t set) const {
  if (!mesh || !has_uv(*mesh.arrays, set) || is_edge_on) return 0;
  const auto position = [&](std::size_t i) { return DVec3(mesh.position(corners[i])); };
  const DVec3 normal = area_vector<1>({position(0), position(1), position(2)});
  const auto area = static_cast<float>(glm::length(normal));
  if (!(area > 0)) return 0;
  Floats2<1> uv[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec2& at = mesh.arrays->uv_sets[set][corners[i]];
    uv[i] = {at.x, at.y};
  }
  return microtrace::uv_scale<1>(uv, area);
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
  const DVec3 n = area_vector<1>({DVec3(t.a), DVec3(t.b), DVec3(t.c)});
  const double area = glm::length(n);
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
