#include "io/gltf/scene/placed_bounds.hpp"

#include <unordered_map>

namespace microtrace::io::gltf {
namespace {

void add_corners(const PointBounds& box, const DMat4& world_from_box, PointBounds& to) {
  for (const DVec3& p : corners_of(box)) to.add(DVec3(world_from_box * DVec4(p, 1)));
}

}  // namespace

PointBounds bounds_of(const Model& model, const std::vector<PlacedNode>& nodes,
                      const std::vector<std::vector<Surface>>& surfaces, const Instances& instances,
                      Poser& poser) {
  std::vector<PointBounds> boxes(surfaces.size());  // by mesh
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    for (const Surface& surface : surfaces[i]) {
      boxes[i].add(surface.box.low);
      boxes[i].add(surface.box.high);
    }
  }
  PointBounds result;
  // The boxes of all meshes with a skin together, so that many of them take no more time than one.
  std::unordered_map<const std::vector<DMat4>*, PointBounds> skinned;
  for (const PlacedNode& placed : nodes) {
    const Model::Node& node = model.nodes[placed.node];
    if (node.camera) result.add(DVec3(placed.world_from_node[3]));
    if (!node.mesh || !placed.visible) continue;
    const PointBounds& box = boxes[*node.mesh];
    if (!(box.low.x <= box.high.x)) continue;
    if (const std::vector<DMat4>* by_joint = poser.world_from_mesh_by_joint(placed.node)) {
      PointBounds& all = skinned[by_joint];
      all.add(box.low);
      all.add(box.high);
      continue;
    }
    if (const InstanceTransforms* each = instances.of(placed.node)) {
      for (std::size_t i = 0; i < each->size(); ++i)
        add_corners(box, placed.world_from_node * (*each)[i], result);
    } else {
      add_corners(box, placed.world_from_node, result);
    }
  }
  for (const auto& [by_joint, box] : skinned) {
    for (const DMat4& world_from_mesh : *by_joint) add_corners(box, world_from_mesh, result);
  }
  return result;
}

}  // namespace microtrace::io::gltf
