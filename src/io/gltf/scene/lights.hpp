#pragma once
/// Makes lights from nodes (KHR_lights_punctual).

#include "io/gltf/document/asset.hpp"
#include "io/gltf/pose/nodes.hpp"

#include <microtrace/scene.hpp>

#include <vector>

namespace microtrace::io::gltf {

/// Returns the lights of visible nodes in node order, with the properties in `root`. A light has
/// the name of its node or, if the node has none, its own. The node's scale has no effect, also
/// where it is 0. Omits, with a warning, lights without a valid position or direction. Throws Error
/// (invalid_scene).
[[nodiscard]] std::vector<NamedLight> make_lights(Asset& asset, const Element& root,
                                                  const Model& model, const NodeTree& tree,
                                                  const std::vector<PlacedNode>& nodes,
                                                  UnflattenedNodes& unflattened);

}  // namespace microtrace::io::gltf
