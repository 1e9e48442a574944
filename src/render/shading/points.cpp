#include "render/shading/hit_lanes.hpp"
#include "render/shading/shading.hpp"

namespace microtrace {

void Shading::points(const ShadingKernels& kernels, std::span<const Ray> rays,
                     std::span<const std::optional<Hit>> hits, HitLanes& lanes,
                     std::span<ShadingPoint> points) const {
  std::uint32_t on_meshes = 0;  // one bit for each hit
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i]) continue;
    const Entry& entry = entries_[primitives_.object_index(hits[i]->id)];
    ShadingPoint& point = points[i];
    point.look = &looks_[entry.look];
    point.texel_address.reset();
    const std::size_t triangle = hits[i]->id - entry.first_id;
    if (entry.mesh == nullptr) {
      point.at = surface_point(primitives_, rays[i], *hits[i], nullptr, triangle);
      continue;
    }
    on_meshes |= 1U << i;
    point.at.mesh = entry.mesh;
    point.at.corners = entry.mesh->triangles[triangle];
    put_hit(lanes, static_cast<int>(i), rays[i], *hits[i], *entry.mesh, point.at.corners);
  }
  if (on_meshes == 0) return;
  kernels.find_points(lanes);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if ((on_meshes >> i & 1U) != 0)
      get_point(lanes, static_cast<int>(i), primitives_, rays[i], *hits[i], points[i].at);
  }
}

}  // namespace microtrace
