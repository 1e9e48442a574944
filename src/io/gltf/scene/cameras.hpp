#pragma once
/// Cameras of nodes.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"
#include "io/gltf/pose/nodes.hpp"

#include <microtrace/scene.hpp>

#include <vector>

namespace microtrace::io::gltf {

/// The cameras of these nodes in their order, with the properties given in `root`. Leaves out, with
/// a warning, a camera whose node has no valid position and orientation, because of a zero scale or
/// numbers beyond float64.
[[nodiscard]] std::vector<NamedCamera> make_cameras(Asset& asset, const JsonValue& root,
                                                    const Model& model, const NodeTree& tree,
                                                    const std::vector<PlacedNode>& nodes);

}  // namespace microtrace::io::gltf
