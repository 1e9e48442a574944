#pragma once
/// Cameras of nodes, and a camera for assets that have none.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"
#include "io/gltf/pose/nodes.hpp"

#include <microtrace/scene.hpp>

#include <vector>

namespace microtrace::io::gltf {

/// The cameras of these nodes in their order, with the properties that the root object has. One
/// whose node has no position and orientation left (a scale of zero, numbers beyond float64) is
/// left out with a warning.
[[nodiscard]] std::vector<NamedCamera> make_cameras(Asset& asset, const JsonValue& root,
                                                    const Model& model, const NodeTree& tree,
                                                    const std::vector<PlacedNode>& nodes);

}  // namespace microtrace::io::gltf
