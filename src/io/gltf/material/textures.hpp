#pragma once
/// Textures of an asset.

#include "io/gltf/document/asset.hpp"

#include <microtrace/texture.hpp>

#include <vector>

namespace microtrace::io::gltf {

/// All textures in file order. A texture with several images uses WebP (EXT_texture_webp) rather
/// than KTX2 (KHR_texture_basisu), and KTX2 rather than PNG or JPEG. Warns of textures without an
/// image.
[[nodiscard]] std::vector<Texture> make_textures(Asset& asset);

}  // namespace microtrace::io::gltf
