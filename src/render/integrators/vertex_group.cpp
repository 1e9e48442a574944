#include "render/integrators/vertex_group.hpp"

#include "render/kernels/lane_access.hpp"

namespace microtrace {
namespace {

void put_tangents(VertexGroup& group, int lane, const SurfacePoint& at) {
  group.handedness[lane] = 0;
  if (at.mesh == nullptr || at.mesh->tangents.empty()) return;
  for (std::size_t corner = 0; corner < 3; ++corner)
    put(group.tangents[corner], lane, Vec3(at.mesh->tangents[at.corners[corner]]));
  group.handedness[lane] = at.mesh->tangents[at.corners[0]].w;
  put(group.hits.lanes.weights, lane, at.barycentrics);
}

void put_map(NormalMapLanes& lanes, int lane, const ShadingPoint& point, const TextureSlot& slot,
             float scale) {
  lanes.is_mapped[lane] = slot.map == nullptr ? 0.0F : 1.0F;
  if (slot.map == nullptr) return;
  put(lanes.texel, lane, Vec3(slot.at(point)));
  lanes.scale[lane] = scale;
}

}  // namespace

void put_point(VertexGroup& group, int lane, const ShadingPoint& point) {
  const SurfacePoint& at = point.at;
  HitLanes& hits = group.hits.lanes;
  put(hits.p, lane, at.p);
  put(hits.n, lane, at.n);
  put(hits.ns, lane, at.ns);
  group.side[lane] = at.front ? 1.0F : -1.0F;
  group.width[lane] = point.width;
  group.on_mesh[lane] = at.mesh != nullptr ? 1 : 0;
  for (std::size_t corner = 0; corner < 3 && at.mesh != nullptr; ++corner)
    put(hits.corners[corner], lane, at.mesh->positions[at.corners[corner]]);

  const TexturedMaterial& look = *point.look;
  const TextureSlot& base = look[MaterialTexture::normal];
  const TextureSlot& coat = look[MaterialTexture::clearcoat_normal];
  if (base.map != nullptr || coat.map != nullptr) {
    group.mapped |= Lanes{1} << lane;
    put_tangents(group, lane, at);
  }
  put_map(group.normals, lane, point, base, look.material->normal_scale);
  const bool has_coat = look.material->clearcoat.has_value();
  put_map(group.coat_normals, lane, point, has_coat ? coat : TextureSlot{},
          has_coat ? look.material->clearcoat->normal_scale : 1);
}

}  // namespace microtrace
