#include "render/shading/hit_group.hpp"
#include "render/shading/hit_lanes.hpp"
#include "render/shading/shading.hpp"

#include <bit>

namespace microtrace {

void Shading::find_points(const ShadingKernels& kernels,
                          std::span<const PrimitiveId, kShadingLanes> ids, HitGroup& group) const {
  Lanes on_meshes = 0;
  for (Lanes rest = group.hit; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    const auto i = static_cast<std::size_t>(lane);
    const Lanes bit = Lanes{1} << lane;
    const Entry& entry = entries_[primitives_.object_index(ids[i])];
    group.looks[i] = &looks_[entry.look];
    group.meshes[i] = entry.mesh;
    if (entry.mesh == nullptr) continue;
    on_meshes |= bit;
    group.corners[i] = entry.mesh->corners(ids[i] - entry.first_id);
    put_positions(group.lanes, lane, *entry.mesh, group.corners[i]);
    const bool has_attributes = !entry.mesh->normals.empty() || has_uv(*entry.mesh);
    if (!has_attributes && (group.with_attributes & bit) == 0) continue;
    put_attributes(group.lanes, lane, *entry.mesh, group.corners[i]);
    group.with_attributes =
        has_attributes ? group.with_attributes | bit : group.with_attributes & ~bit;
  }
  group.sure = 0;
  if (on_meshes == 0) return;
  kernels.find_points(group.lanes);
  for (int lane = 0; lane < kShadingLanes; ++lane)
    group.sure |= Lanes{group.lanes.is_sure[lane] != 0} << lane;
  group.sure &= on_meshes;
}

ShadingPoint Shading::point(const HitGroup& group, int lane, const Ray& ray, const Hit& hit) const {
  const auto i = static_cast<std::size_t>(lane);
  ShadingPoint point{.at = {}, .look = group.looks[i]};
  if ((group.sure >> lane & 1U) == 0) {
    point.at = rounded(interact(primitives_, ray, hit), ray, hit);
    return point;
  }
  point.at.mesh = group.meshes[i];
  point.at.corners = group.corners[i];
  get_sure_point(group.lanes, lane, point.at);
  return point;
}

}  // namespace microtrace
