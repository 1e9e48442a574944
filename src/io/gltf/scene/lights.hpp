#pragma once
/// KHR_lights_punctual.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/pose/nodes.hpp"

#include <microtrace/scene.hpp>

#include <vector>

namespace microtrace::io::gltf {

/// The lights of visible nodes, in the order of the nodes, with the properties that the root object
/// has, named by their nodes or, where a node
/// has no name, by themselves. A node's scale has no effect on them. One without position or
/// direction in the world is left out with a warning. Throws Error (invalid_scene).
[[nodiscard]] std::vector<NamedLight> make_lights(Asset& asset, const Element& root,
                                                  const Model& model, const NodeTree& tree,
                                                  const std::vector<PlacedNode>& nodes);

}  // namespace microtrace::io::gltf
