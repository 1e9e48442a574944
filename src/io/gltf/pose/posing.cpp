#include "io/gltf/pose/posing.hpp"

#include "io/gltf/pose/baking.hpp"

#include <optional>

namespace microtrace::io::gltf {

Poser::Poser(Asset& asset, const tinygltf::Model& model, AccessorReader& reader,
             const NodeTree& tree, const PosedNodes& pose, const DMat4& world_from_asset)
    : model_(model),
      pose_(pose),
      morpher_(asset, model, reader),
      skins_(asset, model, reader, world_from_node_) {
  if (!asset.array("skins").empty()) world_from_node_ = tree.everywhere(world_from_asset, pose);
}

const std::vector<double>& Poser::weights(std::size_t index) const {
  const auto posed = pose_.find(index);
  if (posed != pose_.end() && posed->second.weights) return *posed->second.weights;
  const tinygltf::Node& node = model_.nodes[index];
  if (!node.weights.empty()) return node.weights;
  return model_.meshes[static_cast<std::size_t>(node.mesh)].weights;
}

Mesh Poser::posed(std::size_t index, const Surface& surface, const DMat4& world_from_mesh) {
  const tinygltf::Node& node = model_.nodes[index];
  const auto mesh = static_cast<std::size_t>(node.mesh);
  const Morphed morphed = morpher_.morphed(mesh, surface, weights(index));
  if (has_skin(index)) {
    const std::optional<JointBlend> blend =
        skins_.blend(static_cast<std::size_t>(node.skin), mesh, surface);
    if (blend) return baked(surface.mesh, morphed, *blend);
  }
  return baked(surface.mesh, morphed, world_from_mesh);
}

}  // namespace microtrace::io::gltf
