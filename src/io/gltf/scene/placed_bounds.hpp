#pragma once
#include "io/gltf/document/model.hpp"
#include "io/gltf/mesh/surfaces.hpp"
#include "io/gltf/pose/instances.hpp"
#include "io/gltf/pose/nodes.hpp"
#include "scene/translation_to_origin.hpp"

#include <vector>

namespace microtrace::io::gltf {

/// About all that can be seen, and the cameras: morphed surfaces are taken for what they are
/// without, skinned ones for where their nodes are.
[[nodiscard]] PointBounds bounds_of(const Model& model, const std::vector<PlacedNode>& nodes,
                                    const std::vector<std::vector<Surface>>& surfaces,
                                    const Instances& instances);

}  // namespace microtrace::io::gltf
