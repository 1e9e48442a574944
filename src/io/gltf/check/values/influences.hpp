#pragma once
/// The joints that move vertices, and how much each.

#include "io/gltf/bytes/accessors.hpp"

namespace microtrace::io::gltf {

/// Checks JOINTS_n and WEIGHTS_n of the meshes that skins move. Throws Error (invalid_scene) for a
/// joint that a skin does not have; warns of weights that are negative and of joints that move a
/// vertex twice. Whether weights sum up to 1 is seen where they are used.
void check_influences(Asset& asset, const Model& model, const BufferViews& views);

}  // namespace microtrace::io::gltf
