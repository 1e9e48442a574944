#pragma once
/// Checks the joints and weights of vertices.

#include "io/gltf/bytes/accessors.hpp"

namespace microtrace::io::gltf {

/// Checks JOINTS_n and WEIGHTS_n of skinned meshes. Throws Error (invalid_scene) for a joint
/// missing from the skin. Warns about negative weights, about joints that occur twice in a vertex,
/// and about weights that don't sum to 1.
void check_influences(Asset& asset, const Model& model, const BufferViews& views);

}  // namespace microtrace::io::gltf
