#pragma once
/// KHR_lights_punctual.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/pose/nodes.hpp"

#include <microtrace/scene.hpp>

#include <vector>

namespace microtrace::io::gltf {

/// The lights of visible nodes in node order, with the properties given in `root`. A light is named
/// after its node or, if that has no name, by its own. The node's scale has no effect. Leaves out,
/// with a warning, lights without a valid position or direction. Throws Error (invalid_scene).
[[nodiscard]] std::vector<NamedLight> make_lights(Asset& asset, const Element& root,
                                                  const Model& model, const NodeTree& tree,
                                                  const std::vector<PlacedNode>& nodes);

}  // namespace microtrace::io::gltf
