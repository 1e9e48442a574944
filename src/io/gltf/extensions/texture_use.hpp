#pragma once
/// References from materials to textures, with KHR_texture_transform.

#include "io/json/document.hpp"

#include <microtrace/texture.hpp>

#include <optional>
#include <string_view>

namespace microtrace::io::gltf {

/// Returns the textureInfo with this key, if the object has one.
[[nodiscard]] std::optional<TextureUse> texture_use(const JsonValue& object, std::string_view key);

}  // namespace microtrace::io::gltf
