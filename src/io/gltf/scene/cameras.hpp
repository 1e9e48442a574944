#pragma once
/// Makes cameras from nodes.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"
#include "io/gltf/pose/nodes.hpp"

#include <microtrace/scene.hpp>

#include <vector>

namespace microtrace::io::gltf {

/// Returns the cameras of these nodes in order, with the properties in `root`. For orientations,
/// scale factors of 0 count as 1. Omits, with a warning, cameras whose node has no valid position
/// and orientation because of a singular matrix or numbers beyond float64.
[[nodiscard]] std::vector<NamedCamera> make_cameras(Asset& asset, const JsonValue& root,
                                                    const Model& model, const NodeTree& tree,
                                                    const std::vector<PlacedNode>& nodes,
                                                    UnflattenedNodes& unflattened);

}  // namespace microtrace::io::gltf
