#pragma once
/// Reads the textures of an asset.

#include "io/gltf/document/asset.hpp"

#include <microtrace/texture.hpp>

#include <vector>

namespace microtrace::io::gltf {

/// Returns all textures in file order. If a texture has several images, WebP (EXT_texture_webp)
/// takes precedence over KTX2 (KHR_texture_basisu), and KTX2 over PNG and JPEG. Warns about
/// textures without an image.
[[nodiscard]] std::vector<Texture> make_textures(Asset& asset);

}  // namespace microtrace::io::gltf
