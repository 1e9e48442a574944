#pragma once
#include "io/gltf/document/model.hpp"
#include "io/gltf/mesh/surfaces.hpp"
#include "io/gltf/pose/instances.hpp"
#include "io/gltf/pose/nodes.hpp"
#include "io/gltf/pose/posing.hpp"
#include "scene/translation_to_origin.hpp"

#include <vector>

namespace microtrace::io::gltf {

/// Returns approximate bounds of all visible surfaces and of the cameras. Ignores morph targets.
/// Skinned surfaces are placed by each of their joints.
[[nodiscard]] PointBounds bounds_of(const Model& model, const std::vector<PlacedNode>& nodes,
                                    const std::vector<std::vector<Surface>>& surfaces,
                                    const Instances& instances, Poser& poser);

}  // namespace microtrace::io::gltf
