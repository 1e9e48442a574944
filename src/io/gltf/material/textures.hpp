#pragma once
/// The textures of an asset.

#include "io/gltf/document/asset.hpp"

#include <microtrace/texture.hpp>

#include <vector>

namespace microtrace::io::gltf {

/// All textures in file order. Of the images that one offers, WebP (EXT_texture_webp) comes before
/// KTX2 (KHR_texture_basisu), and this before PNG and JPEG. Warns of textures that offer none.
[[nodiscard]] std::vector<Texture> make_textures(Asset& asset);

}  // namespace microtrace::io::gltf
