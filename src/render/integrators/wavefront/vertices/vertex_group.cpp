#include "render/integrators/wavefront/vertices/vertex_group.hpp"

#include "render/lanes/lane_access.hpp"

namespace microtrace {
namespace {

void put_texel(NormalMapLanes& lanes, int lane, const Vec3& texel, float scale) {
  lanes.is_mapped[lane] = 1;
  put(lanes.texel, lane, texel);
  lanes.scale[lane] = scale;
}

}  // namespace

void put_tangents(VertexGroup& group, int lane, const PlacedMesh& mesh,
                  const std::array<std::uint32_t, 3>& corners) {
  group.mapped |= Lanes{1} << lane;
  group.handedness[lane] = 0;
  if (!mesh || mesh.arrays->tangents.empty()) return;
  for (std::size_t corner = 0; corner < 3; ++corner)
    put(group.tangents[corner], lane, Vec3(mesh.tangent(corners[corner])));
  group.handedness[lane] = mesh.tangent(corners[0]).w;
}

void put_point(VertexGroup& group, int lane, const ShadingPoint& point) {
  const SurfacePoint& at = point.at;
  HitLanes& hits = group.hits.lanes;
  put(hits.p, lane, at.p);
  put(hits.n, lane, at.n);
  put(hits.ns, lane, at.ns);
  group.side[lane] = at.front ? 1.0F : -1.0F;
  group.width[lane] = point.width;
  const bool on_mesh = at.mesh && !at.is_edge_on;
  group.on_mesh[lane] = on_mesh ? 1 : 0;
  for (std::size_t corner = 0; corner < 3 && on_mesh; ++corner)
    put(hits.corners[corner], lane, at.mesh.position(at.corners[corner]));

  const TexturedMaterial& look = *point.look;
  const TextureSlot& base = look[MaterialTexture::normal];
  const TextureSlot& coat = look[MaterialTexture::clearcoat_normal];
  const bool has_coat = coat.map != nullptr && look.material->clearcoat.has_value();
  group.normals.is_mapped[lane] = group.coat_normals.is_mapped[lane] = 0;
  if (base.map == nullptr && !has_coat) return;
  put(hits.weights, lane, at.barycentrics);
  put_tangents(group, lane, at.mesh, at.corners);
  if (base.map != nullptr)
    put_texel(group.normals, lane, Vec3(base.at(point)), look.material->normal_scale);
  if (has_coat) {
    put_texel(group.coat_normals, lane, Vec3(coat.at(point)),
              look.material->clearcoat->normal_scale);
  }
}

}  // namespace microtrace
