#pragma once
/// The textures of an asset, and where its materials use them.

#include "io/gltf/document/asset.hpp"

#include <microtrace/texture.hpp>

#include <optional>
#include <string_view>
#include <vector>

namespace microtrace::io::gltf {

/// All textures in file order. Of the images that one offers, WebP (EXT_texture_webp) comes before
/// KTX2 (KHR_texture_basisu), and this before PNG and JPEG. Warns of textures that offer none.
[[nodiscard]] std::vector<Texture> make_textures(Asset& asset);

/// The textureInfo of that name, if the object has one.
[[nodiscard]] std::optional<TextureUse> texture_use(const JsonValue& object, std::string_view key);

}  // namespace microtrace::io::gltf
