#pragma once
/// Where buffer views and accessors lie.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

namespace microtrace::io::gltf {

/// Checks every buffer view and accessor of the model: in range, strides wide enough, the shape of
/// sparse parts (glTF 2.0, sections 3.6.2.4 and 3.6.2.3). Throws Error (invalid_scene); warns of
/// those that are not aligned.
void check_accessors(Asset& asset, const Model& model);

}  // namespace microtrace::io::gltf
