#include "render/kernels/lane_access.hpp"
#include "render/shading/shading.hpp"

#include <array>

namespace microtrace {
namespace {

bool has_uv(const Mesh& mesh) {
  return !mesh.uv_sets.empty() && !mesh.uv_sets[0].empty();
}

void put_hit(HitLanes& lanes, int lane, const Ray& ray, const Hit& hit, const Mesh& mesh,
             const std::array<std::uint32_t, 3>& corners) {
  put(lanes.o, lane, ray.o);
  put(lanes.d, lane, ray.d);
  lanes.t[lane] = hit.t;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t corner = corners[i];
    put(lanes.corners[i], lane, mesh.positions[corner]);
    put(lanes.normals[i], lane, mesh.normals.empty() ? Vec3(0) : mesh.normals[corner]);
    const Vec2 uv = has_uv(mesh) ? mesh.uv_sets[0][corner] : Vec2(0);
    lanes.uv[i][0][lane] = uv.x;
    lanes.uv[i][1][lane] = uv.y;
  }
}

}  // namespace

void Shading::points(const ShadingKernels& kernels, std::span<const Ray> rays,
                     std::span<const std::optional<Hit>> hits, HitLanes& lanes,
                     std::span<ShadingPoint> points) const {
  std::uint32_t on_meshes = 0;  // one bit per hit
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i]) continue;
    const Entry& entry = entries_[primitives_.object_index(hits[i]->id)];
    ShadingPoint& point = points[i];
    point.look = &looks_[entry.look];
    point.place.reset();
    const std::size_t number = hits[i]->id - entry.first_id;
    if (entry.mesh == nullptr) {
      point.at = surface_point(primitives_, rays[i], *hits[i], nullptr, number);
      continue;
    }
    on_meshes |= 1U << i;
    point.at.mesh = entry.mesh;
    point.at.corners = entry.mesh->triangles[number];
    put_hit(lanes, static_cast<int>(i), rays[i], *hits[i], *entry.mesh, point.at.corners);
  }
  if (on_meshes == 0) return;
  kernels.find_points(lanes);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if ((on_meshes >> i & 1U) == 0) continue;
    const int lane = static_cast<int>(i);
    SurfacePoint& at = points[i].at;
    if (lanes.is_sure[lane] == 0) {
      points[i] = point(rays[i], *hits[i]);
      continue;
    }
    at.p = got(lanes.p, lane);
    at.n = got(lanes.n, lane);
    at.ns = got(lanes.ns, lane);
    at.front = lanes.from_behind[lane] == 0;
    at.distance = lanes.distance[lane];
    at.barycentrics = got(lanes.weights, lane);
    const bool is_textured = has_uv(*at.mesh);
    at.first_uv = is_textured ? Vec2(lanes.first_uv[0][lane], lanes.first_uv[1][lane]) : Vec2(0);
    at.uv_scale = is_textured ? lanes.uv_scale[lane] : 0;
  }
}

}  // namespace microtrace
