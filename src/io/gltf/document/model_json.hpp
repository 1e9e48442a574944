#pragma once
/// Makes the parts of a model that tinygltf doesn't read.

#include "io/gltf/document/model.hpp"

#include <cstddef>
#include <optional>
#include <string_view>

namespace microtrace::io::gltf {

[[nodiscard]] std::size_t index_from(const JsonValue& value);
/// Returns the index in an optional member.
[[nodiscard]] std::optional<std::size_t> index_in(const JsonValue& object, std::string_view key);

/// A file may have a million nodes, and tinygltf would need kilobytes for each.
[[nodiscard]] Model::Node node_of(const JsonValue& json);

/// tinygltf 2.7.0 rejects skins without inverse bind matrices, which glTF allows.
[[nodiscard]] Model::Skin skin_of(const JsonValue& json);

}  // namespace microtrace::io::gltf
