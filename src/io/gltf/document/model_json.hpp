#pragma once
/// Makes the parts of a model that tinygltf doesn't read.

#include "io/gltf/document/model.hpp"

namespace microtrace::io::gltf {

/// A file may have a million nodes, and tinygltf would need kilobytes for each.
[[nodiscard]] Model::Node node_of(const JsonValue& json);

/// tinygltf 2.7.0 rejects skins without inverse bind matrices, which glTF allows.
[[nodiscard]] Model::Skin skin_of(const JsonValue& json);

}  // namespace microtrace::io::gltf
