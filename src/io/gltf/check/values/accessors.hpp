#pragma once
/// Checks the ranges of buffer views and accessors.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

namespace microtrace::io::gltf {

/// Checks that each buffer view and accessor of the model stays in range, that no stride is smaller
/// than an element, and that sparse parts are well formed (glTF 2.0, sections 3.6.2.4 and 3.6.2.3).
/// Throws Error (invalid_scene). Warns about misaligned accessors.
void check_accessors(Asset& asset, const Model& model);

}  // namespace microtrace::io::gltf
