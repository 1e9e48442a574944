#pragma once
/// Transforms surfaces to world space for one pose of the asset.

#include "io/gltf/animation/posed_nodes.hpp"
#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"
#include "io/gltf/mesh/surfaces.hpp"
#include "io/gltf/pose/morphing.hpp"
#include "io/gltf/pose/nodes.hpp"
#include "io/gltf/pose/skins.hpp"

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <cstddef>
#include <vector>

namespace microtrace::io::gltf {

class Poser {
 public:
  /// The arguments must outlive the poser.
  Poser(Asset& asset, const Model& model, AccessorReader& reader, const NodeTree& tree,
        const PosedNodes& pose, const DMat4& world_from_asset);

  /// Returns true if joints, not the node's transform, determine the surface's position.
  [[nodiscard]] bool has_skin(std::size_t node) const {
    return model_.nodes[node].skin.has_value();
  }

  /// Returns the transforms of the node's mesh by each joint of its skin; null without a skin, and
  /// if no primitive of the mesh has joints.
  [[nodiscard]] const std::vector<DMat4>* world_from_mesh_by_joint(std::size_t node);

  /// Returns true if no skin and no morph target moves the surface's vertices.
  [[nodiscard]] bool is_rigid(std::size_t node, const Surface& surface) const;

  /// Returns a surface of the node's mesh in world space. Morphs it, and transforms it by the
  /// skin's joints or, without a skin, by `world_from_mesh`. Throws Error: invalid_scene, limit.
  [[nodiscard]] Mesh posed(std::size_t node, const Surface& surface, const DMat4& world_from_mesh);

 private:
  [[nodiscard]] const std::vector<double>& weights(std::size_t node) const;

  const Model& model_;
  const PosedNodes& pose_;
  std::vector<DMat4> world_from_node_;  // transforms of all nodes; empty without skins
  Morpher morpher_;
  Skins skins_;
};

}  // namespace microtrace::io::gltf
