#pragma once
/// The joints that move vertices, and how much each.

#include "io/gltf/accessors.hpp"

namespace microtrace::io::gltf {

/// Checks JOINTS_n and WEIGHTS_n of the meshes that skins move. Throws Error (invalid_scene) for a
/// joint that a skin does not have; warns of weights that are negative or do not sum up to 1, and
/// of joints that move a vertex twice.
void check_influences(Asset& asset, const tinygltf::Model& model, const BufferViews& views);

}  // namespace microtrace::io::gltf
