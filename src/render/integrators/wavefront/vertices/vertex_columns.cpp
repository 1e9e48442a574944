/// The arrays between which a queue of vertices copies lanes.

#include "render/integrators/wavefront/vertices/vertex_queue.hpp"

namespace microtrace {
namespace {

const LaneNumbers kNone{};

}  // namespace

void VertexQueue::list_paths(const PathColumns& paths) {
  ColumnList& list = from_paths_;
  list.add(paths.throughput, scatter_.throughput);
  list.add(paths.media, media_);
  list.add(paths.scatterings, scatterings_);
  list.add(paths.key, scatter_.key);
  list.add(paths.index, scatter_.index);
  list.add(paths.slot, slots_);
  list.add(paths.channel, channels_);
  list.add(paths.spread, spreads_);
  list.add(paths.t_min, left_.t_min);
}

void VertexQueue::list_group(const VertexGroup& group) {
  const HitLanes& hits = group.hits.lanes;
  ColumnList& list = from_group_;
  list.add(hits.o, left_.o);
  list.add(hits.d, left_.d);
  list.add(hits.corners[0], left_.a);
  list.add(hits.corners[1], left_.b);
  list.add(hits.corners[2], left_.c);
  list.add(hits.p, choices_.points.p);
  list.add(hits.n, points_.n);
  list.add(hits.ns, points_.ns);
  list.add(group.side, points_.side);
  list.add(group.id, ids_);
  list.add(group.on_mesh, on_mesh_);
  list.add(group.width, widths_);
  list.add(group.normals.is_mapped, normals_.is_mapped);
  const SurfaceLanes& from = group.surface;
  SurfaceLanes& to = scatter_.surface;
  list.add(from.base_color, to.base_color);
  list.add(from.metallic, to.metallic);
  list.add(from.roughness, to.roughness);
  list.add(from.f0, to.f0);
  list.add(from.f90, to.f90);
  if (from_maps_.begins(&group)) {
    for (int corner = 0; corner < 3; ++corner)
      from_maps_.add(group.tangents[corner], points_.tangents[corner]);
    from_maps_.add(group.handedness, points_.handedness);
    from_maps_.add(hits.weights, points_.weights);
    from_maps_.add(group.normals.texel, normals_.texel);
    from_maps_.add(group.normals.scale, normals_.scale);
  }
  if (from_extensions_.begins(&group)) list_extensions(group);
}

void VertexQueue::list_extensions(const VertexGroup& group) {
  const SurfaceLanes& from = group.surface;
  SurfaceLanes& to = scatter_.surface;
  ColumnList& list = from_extensions_;
  list.add(from.transmission, to.transmission);
  list.add(from.eta, to.eta);
  list.add(from.diffuse_transmission, to.diffuse_transmission);
  list.add(from.diffuse_transmission_color, to.diffuse_transmission_color);
  list.add(from.anisotropy, to.anisotropy);
  list.add(from.along, to.along);
  list.add(from.film_share, to.film_share);
  list.add(from.film_ior, to.film_ior);
  list.add(from.film_thickness, to.film_thickness);
  list.add(from.sheen, to.sheen);
  list.add(from.sheen_roughness, to.sheen_roughness);
  list.add(from.coat, to.coat);
  list.add(from.coat_roughness, to.coat_roughness);
  list.add(group.through_weight, scatter_.through_weight);
  list.add(group.media, below_media_);
  list.add(group.channel, below_channels_);
  list.add(group.coat_normals.is_mapped, coat_normals_.is_mapped);
  list.add(group.coat_normals.texel, coat_normals_.texel);
  list.add(group.coat_normals.scale, coat_normals_.scale);
}

void VertexQueue::list_next(PathColumns& paths) {
  ColumnList& list = to_paths_;
  list.add(origins_.origin, paths.o);
  list.add(origins_.direction, paths.d);
  list.add(ids_, paths.left);
  list.add(scatter_.key, paths.key);
  list.add(scatter_.index, paths.index);
  list.add(slots_, paths.slot);
  list.add(scatter_.next_throughput, paths.throughput);
  list.add(scatter_.pdf, paths.pdf);
  list.add(choices_.points.p, paths.from_p);
  list.add(scatter_.frame_n, paths.from_n);
  list.add(media_, paths.media);
  list.add(scatterings_, paths.scatterings);
  list.add(kNone, paths.is_scattered);
  list.add(channels_, paths.channel);
  list.add(widths_, paths.begin);
  list.add(spreads_, paths.spread);
}

}  // namespace microtrace
