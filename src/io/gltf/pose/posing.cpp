#include "io/gltf/pose/posing.hpp"

#include "io/gltf/pose/baking.hpp"

#include <algorithm>
#include <optional>

namespace microtrace::io::gltf {

Poser::Poser(Asset& asset, const Model& model, AccessorReader& reader, const NodeTree& tree,
             const PosedNodes& pose, const DMat4& world_from_asset)
    : model_(model),
      pose_(pose),
      morpher_(asset, model, reader),
      skins_(asset, model, reader, world_from_node_) {
  if (!model.skins.empty()) world_from_node_ = tree.everywhere(world_from_asset, pose);
}

const std::vector<double>& Poser::weights(std::size_t index) const {
  const auto posed = pose_.find(index);
  if (posed != pose_.end() && posed->second.weights) return *posed->second.weights;
  const Model::Node& node = model_.nodes[index];
  if (!node.weights.empty()) return node.weights;
  return model_.meshes[*node.mesh].weights;
}

const std::vector<DMat4>* Poser::world_from_mesh_by_joint(std::size_t index) {
  const Model::Node& node = model_.nodes[index];
  if (!node.skin || !node.mesh) return nullptr;
  const auto has_joints = [](const Model::Primitive& primitive) {
    return primitive.attributes.contains("JOINTS_0") && primitive.attributes.contains("WEIGHTS_0");
  };
  if (!std::ranges::any_of(model_.meshes[*node.mesh].primitives, has_joints)) return nullptr;
  const std::vector<DMat4>& matrices = skins_.matrices(*node.skin);
  return matrices.empty() ? nullptr : &matrices;
}

bool Poser::is_rigid(std::size_t index, const Surface& surface) const {
  const Model::Node& node = model_.nodes[index];
  return !node.skin && model_.meshes[*node.mesh].primitives[surface.number].targets.empty();
}

Mesh Poser::posed(std::size_t index, const Surface& surface, const DMat4& world_from_mesh) {
  const Model::Node& node = model_.nodes[index];
  const Morphed morphed = morpher_.morphed(*node.mesh, surface, weights(index));
  if (node.skin) {
    const std::optional<JointBlend> blend = skins_.blend(*node.skin, *node.mesh, surface);
    if (blend) return baked(surface.mesh, morphed, *blend, world_from_mesh);
  }
  return baked(surface.mesh, morphed, world_from_mesh);
}

}  // namespace microtrace::io::gltf
