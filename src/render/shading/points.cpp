#include "render/shading/points/hit_group.hpp"
#include "render/shading/points/hit_lanes.hpp"
#include "render/shading/shading.hpp"

#include <array>
#include <bit>

namespace microtrace {

// Works in steps, each of which prefetches the data of the next step, because most meshes don't fit
// into the fastest caches.
void Shading::find_points(const ShadingKernels& kernels,
                          std::span<const PrimitiveId, kShadingLanes> ids, HitGroup& group) const {
  group.flat = flat_triangles_.find(ids, group.hit, group.flat_hits);
  Lanes on_meshes = 0;
  std::array<std::size_t, kShadingLanes> triangles;
  for (Lanes rest = group.hit & ~group.flat; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    const Entry& entry = entry_of(ids[i]);
    group.looks[i] = &looks_[entry.look];
    const MeshTriangle triangle = entry.triangle(ids[i]);
    group.meshes[i] = triangle.mesh;
    if (!triangle.mesh) continue;
    on_meshes |= Lanes{1} << i;
    triangles[i] = triangle.index;
    __builtin_prefetch(&triangle.mesh.arrays->triangles[triangles[i]]);
  }
  for (Lanes rest = on_meshes; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    group.corners[i] = group.meshes[i].corners(triangles[i]);
    prefetch_corners(*group.meshes[i].arrays, group.corners[i]);
  }
  for (Lanes rest = on_meshes; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    const auto i = static_cast<std::size_t>(lane);
    const Lanes bit = Lanes{1} << lane;
    const PlacedMesh& mesh = group.meshes[i];
    put_positions(group.lanes, lane, mesh, group.corners[i]);
    const bool has_attributes = !mesh.arrays->normals.empty() || has_uv(*mesh.arrays);
    if (!has_attributes && (group.with_attributes & bit) == 0) continue;
    put_attributes(group.lanes, lane, mesh, group.corners[i]);
    group.with_attributes =
        has_attributes ? group.with_attributes | bit : group.with_attributes & ~bit;
  }
  if ((on_meshes | group.flat) == 0) {
    group.sure = 0;
    return;
  }
  if (on_meshes != 0) kernels.find_points(group.lanes);
  if (group.flat != 0)
    kernels.find_flat_points(flat_triangles_.triangles(), group.flat_hits, group.lanes);
  group.sure = 0;
  for (int lane = 0; lane < kShadingLanes; ++lane)
    group.sure |= Lanes{group.lanes.is_sure[lane] != 0} << lane;
  group.sure &= on_meshes | group.flat;
}

void Shading::load_surfaces(const ShadingKernels& kernels, const HitGroup& group,
                            SurfaceLanes& surface) const {
  kernels.load_surfaces(flat_triangles_.surfaces(), group.flat_hits.surfaces, surface);
}

ShadingPoint Shading::point(const HitGroup& group, int lane, const Ray& ray, const Hit& hit) const {
  const auto i = static_cast<std::size_t>(lane);
  const bool is_flat = (group.flat >> lane & 1U) != 0;
  const Entry& entry = entry_of(hit.id);
  ShadingPoint point{.at = {}, .look = &looks_[entry.look]};
  if ((group.sure >> lane & 1U) == 0) {
    point.at = rounded(interact(primitives_, ray, hit), ray, hit);
    return point;
  }
  const MeshTriangle triangle = entry.triangle(hit.id);
  point.at.mesh = triangle.mesh;
  point.at.corners = is_flat ? triangle.mesh.corners(triangle.index) : group.corners[i];
  get_sure_point(group.lanes, lane, point.at);
  return point;
}

}  // namespace microtrace
