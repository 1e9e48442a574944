#pragma once
/// The asset as tinygltf's model.

#include "io/gltf/document/asset.hpp"

#include <tiny_gltf.h>

namespace microtrace::io::gltf {

/// Parses what the scene is made of (scenes, nodes, meshes, accessors, bufferViews, materials,
/// cameras) from JSON that check_schema has accepted. Extensions, extras, images, buffers and all
/// else do not reach tinygltf; it opens no file. Throws Error.
[[nodiscard]] tinygltf::Model parse_model(const Asset& asset);

}  // namespace microtrace::io::gltf
